import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import gains, generators, metres, random_state, scenarios, speeds

from drake_formation import load_scenario, metrics, simulate
from drake_formation.formation import graphs
from drake_formation.parts.coordination.consensus import ConsensusController, consensus_force
from drake_formation.parts.coordination.distances import distance_force
from drake_formation.scenario import resolve, warnings

relative = st.tuples(metres, metres, speeds, speeds)
displacements = st.tuples(metres, metres)
apart = relative.filter(lambda x: np.hypot(x[0], x[1]) > 0.1)
turns = st.floats(-np.pi, np.pi)


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


def turned(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


@given(apart, gains, gains, displacements, turns)
def test_consensus_on_distances_turns_with_the_robots(x, delta, delta_v, h, angle):
    """Frame-indifference: only the motion is turned, not the desired displacement."""
    dx, dy, dvx, dvy = x
    moved = [*(turned(angle) @ [dx, dy]).tolist(), *(turned(angle) @ [dvx, dvy]).tolist()]
    size = 1e-12 * (1 + 100 * (delta + delta_v))
    expected = turned(angle) @ distance_force(*x, delta, delta_v, *h)
    np.testing.assert_allclose(distance_force(*moved, delta, delta_v, *h), expected, rtol=1e-9, atol=size)


@given(apart, gains, displacements)
def test_consensus_on_distances_is_the_gradient_of_its_potential(x, delta, h):
    place, step, rest = np.array(x[:2]), 1e-6, np.hypot(*h)

    def potential(q):
        return delta * (np.hypot(*q) - rest) ** 2 / 2

    slope = [(potential(place + d) - potential(place - d)) / (2 * step) for d in step * np.eye(2)]
    np.testing.assert_allclose(distance_force(*x, delta, 0.0, *h), np.negative(slope), atol=1e-6 * (1 + 10 * delta))


@given(apart, gains, gains, displacements)
def test_consensus_on_distances_damps_along_the_line_alone(x, delta, delta_v, h):
    dx, dy, dvx, dvy = x
    damped = np.subtract(distance_force(*x, delta, delta_v, *h), distance_force(*x, delta, 0.0, *h))
    along = (dx * dvx + dy * dvy) / np.hypot(dx, dy)
    assert damped @ [dvx, dvy] == pytest.approx(-delta_v * along**2, rel=1e-6, abs=1e-6)


FREE = {"tracking": {"kind": "none"}, "springs.stiffness": 0.0, "aggregation.duration": 0.0}
"""Nothing acts on the robots but consensus."""


def end_of(law, start, engine="blocks"):
    given = {"law": law, "delta": 200.0, "delta_v": 80.0}
    overrides = {**FREE, "transport.duration": 3.0, "robots.start": start.tolist(), "consensus": given}
    return simulate(load_scenario("quadrilateral", overrides=overrides), engine=engine)["position"][-1].values


def test_a_turned_formation_stays_turned_by_distances_and_turns_back_by_displacements():
    slots = resolve(load_scenario("quadrilateral")).slots
    start = slots @ turned(0.4).T
    np.testing.assert_allclose(end_of("hookean", start), start, atol=1e-9)
    np.testing.assert_allclose(end_of("linear", start), slots, atol=0.05)


def test_distances_hold_the_shape():
    slots = resolve(load_scenario("quadrilateral")).slots
    start = slots * [1.3, 0.9]
    end = end_of("hookean", start)
    distances = [[np.linalg.norm(places[i] - places[j]) for i in range(4) for j in range(i)] for places in (slots, end)]
    np.testing.assert_allclose(*distances, atol=0.02)
    np.testing.assert_allclose(end_of("hookean", start, "compiled"), end, atol=1e-6)


def test_robots_may_have_laws_of_their_own():
    consensus = {"law": {"2": "hookean", "default": "linear"}, "delta": 100.0}
    scenario = load_scenario("line", overrides={"consensus": consensus, "transport.duration": 1.0})
    ends = [simulate(scenario, engine=engine)["position"][-1] for engine in ("blocks", "compiled")]
    np.testing.assert_allclose(*ends, atol=1e-6)
    assert metrics(simulate(scenario)).peak_force_n > 0


@pytest.mark.parametrize(
    ("graph", "told"),
    [("complete", ""), ([[1, 2], [2, 3], [3, 4], [1, 4], [1, 3]], ""), ("cycle", "4 independent"), ("star", "3 ind")],
)
def test_who_asks_for_distances_over_a_flexible_graph_is_warned(graph, told):
    overrides = {"consensus": {"law": "hookean", "delta": 1.0, "graph": graph}}
    found = warnings(load_scenario("quadrilateral", overrides=overrides))
    assert len(found) == bool(told)
    assert all(told in str(fault) and fault.path == ("consensus", "graph") for fault in found)
    assert not warnings(load_scenario("quadrilateral", overrides={**overrides, "consensus.law": "linear"}))
    assert not warnings(load_scenario("quadrilateral", overrides={**overrides, "consensus.delta": 0.0}))


def test_validate_prints_the_warning_and_takes_the_scenario(cli):
    status, out, _ = cli("validate", "quadrilateral", "--set", "consensus={law: hookean, delta: 1.0, graph: cycle}")
    assert status == 0
    assert "rank 4 of 5" in out  # consensus
    assert "rank 5 of 5" in out  # springs
    assert "warning: consensus.graph: law hookean does not hold the shape" in out
