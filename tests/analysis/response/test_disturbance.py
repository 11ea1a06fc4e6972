"""Disturbances: norms computed another way, and the diagram itself hit, shaken and left to noise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.systems.analysis import Simulator
from strategies import generators, scenarios

from drake_formation import build_diagram, load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.norms import h2_norm, hinf_norm
from drake_formation.analysis.response.disturbance import Disturbance, disturbance, force_to_error, noise_floor
from drake_formation.scenario import resolve

QUICK = {"tracking.Q": 400.0, "robots.mass": 4.0, "springs.stiffness": 20.0}
"""Robots that forget within half a second, so that a short run has many independent samples."""


def blown(formation, blows, step):
    """Consensus errors of the diagram itself under blows (N s, shape (T, N, 2)), one every step; shape (T, N, 2)."""
    diagram = build_diagram(formation.scenario)
    simulator = Simulator(diagram)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    fastest = np.abs(np.linalg.eigvals(formation.A)).max()
    simulator.get_mutable_integrator().set_maximum_step_size(min(step, 0.2 / fastest))
    context = simulator.get_mutable_context()
    ports = [diagram.GetOutputPort(f"robot_{i + 1}_consensus_error") for i in range(formation.robots)]
    masses = resolve(formation.scenario).masses[:, None]
    errors = []
    for k, blow in enumerate(blows):
        motion = context.get_continuous_state_vector().CopyToVector().reshape(-1, 4)
        motion[:, 2:] += blow / masses
        context.SetContinuousState(motion.ravel())
        simulator.AdvanceTo(step * (k + 1))
        errors.append([port.Eval(context) for port in ports])
    return np.array(errors)


@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("line", {}),
        ("line", {"springs.stiffness": 3e4}),
        ("quadrilateral", {"consensus.delta": 100.0, "consensus.graph": "path"}),
        ("octagon", {"consensus.delta": 1e4}),
    ],
)
def test_a_short_blow_comes_close_to_the_bound(name, overrides):
    formation = linearize(load_scenario(name, overrides=overrides))
    peaks = disturbance(formation).pulse
    hit = int(np.argmax(peaks.bound))
    # Which way the blow must go: the first singular vector of the response at its peak.
    system = force_to_error(formation, formation.delta, formation.delta_v)
    values, vectors = np.linalg.eig(system.A)
    response = (system.C @ vectors * np.exp(values * peaks.time[hit])) @ np.linalg.solve(vectors, system.B)
    erring = slice(2 * peaks.robot[hit], 2 * peaks.robot[hit] + 2)
    _, _, ways = np.linalg.svd(response[erring, 2 * hit : 2 * hit + 2].real)
    steps = 80
    blows = np.zeros((steps, formation.robots, 2))
    impulse = 1e-3
    blows[0, hit] = impulse * ways[0]
    errors = np.linalg.norm(blown(formation, blows, 1.25 * peaks.time[hit] / steps), axis=-1)
    assert 0.99 * impulse * peaks.bound.max() < errors.max() <= impulse * peaks.bound.max() * (1 + 1e-4)


@given(scenario=scenarios(robots=st.integers(2, 4)), rng=generators)
@settings(max_examples=8)
def test_no_train_of_blows_moves_the_diagram_beyond_the_bound(scenario, rng):
    formation = linearize(scenario)
    blows = 1e-3 * rng.normal(size=(60, formation.robots, 2)) * (rng.random((60, 1, 1)) < 0.3)
    impulses = np.linalg.norm(blows, axis=-1).sum(axis=0)
    errors = np.linalg.norm(blown(formation, blows, 0.02), axis=-1)
    assert errors.max() <= disturbance(formation).error_bound(impulses)


@pytest.mark.slow
def test_noise_floor_of_the_diagram():
    """White forces as independent blows: the RMS over a long run is the Lyapunov equation's."""
    formation = linearize(load_scenario("quadrilateral", overrides=QUICK | {"consensus.delta": 20.0}))
    density, step = 0.05, 0.04
    rng = np.random.default_rng(5)
    blows = density * np.sqrt(step / 2) * rng.normal(size=(6000, formation.robots, 2))
    errors = blown(formation, blows, step)[50:]
    floor = density * disturbance(formation).force_floor
    rms = np.sqrt((errors**2).sum(axis=-1).mean(axis=0))
    np.testing.assert_allclose(rms, floor, rtol=0.06)
    np.testing.assert_allclose(np.linalg.norm(rms), np.linalg.norm(floor), rtol=0.03)


@pytest.mark.slow
def test_the_diagram_shaken_at_its_resonance():
    """A sinusoidal force as blows drives all errors together to the H∞ norm times its amplitude."""
    formation = linearize(load_scenario("line", overrides=QUICK | {"consensus.delta": 200.0}))
    found = disturbance(formation)
    step = 2 * np.pi / found.hinf.frequency / 60
    times = step * np.arange(60 * 30)
    blows = np.zeros((len(times), 2, 2))
    blows[:, found.hinf_robot - 1, 0] = 1e-2 * np.sin(found.hinf.frequency * times) * step
    across = np.linalg.norm(blown(formation, blows, step)[-60:].reshape(60, -1), axis=1).max()
    blows = blows[..., ::-1]
    along = np.linalg.norm(blown(formation, blows, step)[-60:].reshape(60, -1), axis=1).max()
    np.testing.assert_allclose(max(across, along), 1e-2 * found.hinf.gain, rtol=5e-3)


@given(scenario=scenarios(robots=st.integers(2, 4)))
@settings(max_examples=15)
def test_norms_robot_by_robot(scenario):
    formation = linearize(scenario)
    found = disturbance(formation)
    system = force_to_error(formation, formation.delta, formation.delta_v)
    each = [system._replace(B=system.B[:, 2 * j : 2 * j + 2]) for j in range(formation.robots)]
    np.testing.assert_allclose(found.h2, [h2_norm(one) for one in each], rtol=1e-6)
    np.testing.assert_allclose(found.h2_all, h2_norm(system), rtol=1e-6)
    np.testing.assert_allclose(found.hinf.gain, max(hinf_norm(one).gain for one in each), rtol=3e-6)
    np.testing.assert_allclose(found.hinf_all.gain, hinf_norm(system).gain, rtol=3e-6)
    assert found.hinf.gain <= found.hinf_all.gain * (1 + 3e-6)
    # All robots' floors together are the H2 norm, with half the density as intensity.
    np.testing.assert_allclose(np.linalg.norm(found.force_floor), found.h2_all / np.sqrt(2), rtol=1e-6)


def test_noise_that_two_robots_hear():
    """e₁ = (s₁ − s₂)/2 feels δ (n₂ − n₁)/2: intensity δ²/4 on an oscillator with m, d = 9 and 1 + 2δ, on two axes."""
    delta = 1e4
    formation = linearize(load_scenario("line", overrides={"consensus.delta": delta, "springs.stiffness": 0.0}))
    expected = np.sqrt(2 * delta**2 / 4 / (2 * 9 * (1 + 2 * delta)))
    np.testing.assert_allclose(disturbance(formation).position_floor, expected, rtol=1e-6)
    assert np.all(disturbance(formation).velocity_floor == 0)


def test_velocity_noise_comes_with_velocity_consensus():
    delta_v = 30.0
    overrides = {"consensus.delta": 100.0, "consensus.delta_v": delta_v, "springs.stiffness": 0.0}
    found = disturbance(linearize(load_scenario("line", overrides=overrides)))
    expected = np.sqrt(2 * delta_v**2 / 4 / (2 * (9 + 2 * delta_v) * 201))
    np.testing.assert_allclose(found.velocity_floor, expected, rtol=1e-6)


def test_other_gains_than_the_scenario_has():
    formation = linearize(load_scenario("quadrilateral"))
    changed = linearize(load_scenario("quadrilateral", overrides={"consensus.delta": 50.0, "consensus.delta_v": 5.0}))
    expected = disturbance(changed)
    found = disturbance(formation, delta=50.0, delta_v=5.0)
    np.testing.assert_allclose(found.pulse.bound, expected.pulse.bound, rtol=1e-9)
    np.testing.assert_allclose(found.hinf_all.gain, expected.hinf_all.gain, rtol=1e-6)
    np.testing.assert_allclose(found.position_floor, expected.position_floor, rtol=1e-9)
    np.testing.assert_allclose(found.velocity_floor, expected.velocity_floor, rtol=1e-9)


def test_damping_between_robots_only_helps():
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus.delta": 1e4}))
    plain, damped = disturbance(formation), disturbance(formation, delta_v=500.0)
    assert damped.h2_all < plain.h2_all
    assert damped.hinf_all.gain < plain.hinf_all.gain
    assert damped.pulse.bound.max() < plain.pulse.bound.max()


def test_one_number_hits_the_worst_robot():
    found = disturbance(linearize(load_scenario("quadrilateral", overrides={"consensus.graph": "star"})))
    one_at_a_time = [found.error_bound(3.0 * blow) for blow in np.eye(4)]
    assert found.error_bound(3.0) == pytest.approx(max(one_at_a_time))


def test_plain_values_have_units_and_robots_from_one():
    found = disturbance(linearize(load_scenario("line")))
    assert isinstance(found, Disturbance)
    values = found.to_dict()
    assert values["pulse_on_robot"] in {1, 2}
    assert values["hinf_on_robot"] in {1, 2}
    assert values["pulse_error_m_per_ns"] == pytest.approx(0.0359, rel=1e-2)


def test_one_robot_cannot_disagree():
    scenario = load_scenario(
        "line", overrides={"formation.robots": 1, "robots.start": {"centre": [0, 0]}, "avoidance.obstacles": []}
    )
    with pytest.raises(IllPosedError, match="at least two robots"):
        disturbance(linearize(scenario))


def test_an_unstable_loop_has_no_floor():
    formation = linearize(load_scenario("line"))
    system = force_to_error(formation, -10.0, 0.0)
    with pytest.raises(IllPosedError, match="not asymptotically stable"):
        noise_floor(system)
    with pytest.raises(IllPosedError, match="not asymptotically stable"):
        disturbance(formation, delta=-10.0)
