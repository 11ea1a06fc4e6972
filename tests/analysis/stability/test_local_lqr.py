"""The local loop: the Riccati equation solved a second way, margins in closed form, and what the margins promise."""

import numpy as np
import pytest
from hypothesis import given, settings
from pydrake.systems.analysis import Simulator
from scipy.linalg import solve_continuous_are
from strategies import scenarios

from drake_formation import build_diagram, load_scenario
from drake_formation.analysis.linear.linearization import linearize
from drake_formation.analysis.stability.local_lqr import local_loops
from drake_formation.parts.tracking.costs import cost_matrix
from drake_formation.parts.tracking.lqr import robot_matrices


@given(scenario=scenarios())
@settings(max_examples=15)
def test_theorem_1_holds_for_every_scenario(scenario):
    q, r = cost_matrix(scenario.tracking.Q, 4), cost_matrix(scenario.tracking.R, 2)
    for loop in local_loops(linearize(scenario)):
        a, b = robot_matrices(loop.mass)
        np.testing.assert_allclose(loop.P, solve_continuous_are(a, b, q, r), rtol=1e-6)
        assert max(loop.riccati_residual, loop.gain_residual, loop.lyapunov_residual) < 1e-9
        assert loop.stable
        assert loop.decrease.max() < 0
        assert 0 < loop.certified_decay_rate <= loop.decay_rate * (1 + 1e-9)


@given(scenario=scenarios())
@settings(max_examples=15)
def test_kalmans_inequality_holds_for_every_lqr(scenario):
    assert all(loop.margins.return_difference > 1 - 1e-9 for loop in local_loops(linearize(scenario)))


@given(scenario=scenarios(isotropic=True))
@settings(max_examples=15)
def test_no_lqr_has_less_than_the_guaranteed_margins(scenario):
    for loop in local_loops(linearize(scenario)):
        assert loop.margins.independent
        assert loop.margins.lowest_gain <= 0.5
        assert loop.margins.highest_gain is None
        assert loop.margins.phase_deg > 60


def test_robots_of_one_mass_share_an_entry():
    loops = local_loops(linearize(load_scenario("quadrilateral", overrides={"robots.mass": [40.0, 20.0, 40.0, 30.0]})))
    assert [(loop.mass, loop.robots) for loop in loops] == [(20.0, (2,)), (30.0, (4,)), (40.0, (1, 3))]


def test_the_papers_loop():
    (loop,) = local_loops(linearize(load_scenario("line")))
    np.testing.assert_allclose(loop.K, [[1, 0, 9, 0], [0, 1, 0, 9]], atol=1e-12)
    np.testing.assert_allclose(loop.P, np.kron([[9, 40], [40, 360]], np.eye(2)), rtol=1e-9, atol=1e-9)
    # −(I + KᵀK) has −1 on what K maps to nothing and −(1 + 1² + 9²) across.
    np.testing.assert_allclose(loop.decrease, [-83, -83, -1, -1])
    assert loop.decay_rate == pytest.approx(9 / 80)


def test_phase_margin_is_that_of_one_axis():
    """|L| = 1 for L = (p + d s)/(m s²) at m² ω⁴ − d² ω² − p² = 0."""
    (loop,) = local_loops(linearize(load_scenario("line")))
    p, d, m = 1.0, 9.0, 40.0
    crossover = np.sqrt((d**2 + np.sqrt(d**4 + 4 * m**2 * p**2)) / (2 * m**2))
    assert loop.margins.phase_deg == pytest.approx(np.degrees(np.arctan2(d * crossover, p)), rel=1e-9)
    assert loop.margins.lowest_gain == 0
    assert loop.margins.highest_gain is None


@pytest.mark.parametrize(("share", "grows"), [(0.95, False), (1.05, True)])
def test_a_lag_beyond_the_phase_margin_destabilizes(share, grows):
    """A phase lag at the input, as the delay that it is at the crossover, integrated with the delayed input stored."""
    (loop,) = local_loops(linearize(load_scenario("line")))
    crossover = np.sqrt((81 + np.sqrt(81**2 + 4 * 40**2)) / (2 * 40**2))
    step = 1e-3
    lag = round(share * np.radians(loop.margins.phase_deg) / crossover / step)
    past = np.zeros((lag + 1, 2))
    past[:, 0] = 1.0
    position, velocity, amplitude = 1.0, 0.0, []
    steps = round(200 / step)
    for n in range(steps):
        old_position, old_velocity = past[n % (lag + 1)]
        past[n % (lag + 1)] = position, velocity
        velocity -= step * (old_position + 9 * old_velocity) / 40
        position += step * velocity
        amplitude.append(abs(position))
    early, late = max(amplitude[steps // 4 : steps // 2]), max(amplitude[3 * steps // 4 :])
    assert (late > early) == grows


def test_v_falls_along_a_simulated_motion():
    """V = εᵀPε of the diagram's own motion never falls slower than the certified rate."""
    scenario = load_scenario("line", overrides={"springs.graph": [], "avoidance.obstacles": [], "robots.mass": 25.0})
    (loop,) = local_loops(linearize(scenario))
    diagram = build_diagram(scenario)
    simulator = Simulator(diagram)
    context = simulator.get_context()
    values = []
    for time in np.linspace(0, 20, 41):
        simulator.AdvanceTo(time)
        error = diagram.GetOutputPort("robot_1_tracking_error").Eval(context)
        values.append(error @ loop.P @ error)
    fall = np.array(values[1:]) / np.array(values[:-1])
    assert np.all(fall <= np.exp(-2 * loop.certified_decay_rate * 0.5) * (1 + 1e-6))
