import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import gains, generators, metres, random_state, scenarios, speeds

from drake_formation.formation import graphs
from drake_formation.parts.coordination.consensus import ConsensusController, consensus_force
from drake_formation.scenario import resolve

relative = st.tuples(metres, metres, speeds, speeds)
displacements = st.tuples(metres, metres)


@given(relative, gains, gains, displacements)
def test_two_robots_draw_each_other_alike(x, delta, delta_v, h):
    one = consensus_force(*x, delta, delta_v, *h)
    other = consensus_force(*np.negative(x).tolist(), delta, delta_v, *np.negative(h).tolist())
    assert one == tuple(-f for f in other)


@given(gains, gains, displacements)
def test_robots_in_formation_feel_nothing(delta, delta_v, h):
    assert consensus_force(*h, 0.0, 0.0, delta, delta_v, *h) == (0, 0)


@given(relative, gains, gains, displacements)
def test_consensus_takes_energy_away_by_delta_v_alone(x, delta, delta_v, h):
    dvx, dvy = x[2:]
    damped = np.subtract(consensus_force(*x, delta, delta_v, *h), consensus_force(*x, delta, 0.0, *h))
    assert damped @ [dvx, dvy] == pytest.approx(-delta_v * (dvx**2 + dvy**2), rel=1e-9, abs=1e-9)


@given(scenarios(obstacles=st.just(0)), generators)
def test_forces_follow_the_laplacian_and_sum_to_zero_over_any_graph(scenario, rng):
    """u_g = −(L ⊗ Δ) (x − h) (paper, Eq. 17), from the blocks wired by hand."""
    state, slots = random_state(scenario, rng), resolve(scenario).slots
    graph, gain = resolve(scenario).channels.graph, (scenario.consensus.delta, scenario.consensus.delta_v)
    forces = np.array([force(graph, i, gain, slots, state) for i in range(len(slots))])

    agreed = gain[0] * (state[:, :2] - slots) + gain[1] * state[:, 2:]
    np.testing.assert_allclose(forces, -graphs.laplacian(graph) @ agreed, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(forces.sum(axis=0), 0, atol=1e-9)


def force(graph, robot, gains, slots, state):
    neighbours = graphs.neighbours(graph, robot)
    block = ConsensusController([j + 1 for j in neighbours], gains, slots[robot] - slots[neighbours])
    context = block.CreateDefaultContext()
    block.GetInputPort("state").FixValue(context, state[robot])
    for j in neighbours:
        block.GetInputPort(f"channel_{j + 1}").FixValue(context, state[j])
    return block.GetOutputPort("force").Eval(context)
