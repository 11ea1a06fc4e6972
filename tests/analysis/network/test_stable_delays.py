"""Delays at which a linear system is stable: known answers, laws, and two independent packages."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import generators

from drake_formation.analysis import stable_delays
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network import delay_crossings

TWO_STATES = np.diag([-2.0, -0.9]), np.array([[-1.0, 0.0], [-1.0, -1.0]])
"""A benchmark of the literature on delays (Gu, Kharitonov and Chen 2003)."""

UNSTABLE_WITHOUT = np.array([[0.0, 1.0], [-2.0, 0.1]]), np.array([[0.0, 0.0], [1.0, 0.0]])
"""ẍ = 0.1 ẋ − 2 x + x(t − τ): what delays may do for stability (same book)."""

SERVO = np.array([[0.0, 1.0], [0.0, -0.1]]), -np.array([[0.0], [0.1]]) @ np.array([[3.75, 11.5]])
"""Networked state feedback (Zhang, Branicky and Phillips 2001)."""


@pytest.mark.parametrize(
    ("system", "low", "high"),
    [(TWO_STATES, 0.0, 6.172581), (UNSTABLE_WITHOUT, 0.100168, 1.717858), (SERVO, 0.0, 1.167144)],
)
def test_known_answers(system, low, high):
    (stable,) = stable_delays(*system)
    assert stable == pytest.approx((low, high), abs=6e-7)


@pytest.mark.parametrize(
    ("graph", "largest"),
    [(nx.complete_graph(4), 4.0), (nx.star_graph(4), 5.0), (nx.cycle_graph(6), 4.0), (nx.complete_graph(11), 11.0)],
)
def test_single_integrators_in_consensus(graph, largest):
    """q̇ = −L q(t − τ) about its mean: π/(2 λ_N), however often λ_N occurs (Olfati-Saber and Murray 2004)."""
    laplacian = nx.laplacian_matrix(graph).toarray().astype(float)
    mean = np.ones_like(laplacian) / len(laplacian)
    (stable,) = stable_delays(-mean, -laplacian)
    assert stable == pytest.approx((0.0, np.pi / 2 / largest), rel=1e-9)


def test_the_known_delay_of_four_robots_that_all_hear_each_other():
    laplacian = nx.laplacian_matrix(nx.complete_graph(4)).toarray()
    assert stable_delays(-np.ones((4, 4)) / 4, -laplacian)[0].high == pytest.approx(0.392699, abs=5e-7)


def test_a_delay_may_calm_an_undamped_oscillation_again_and_again():
    """ẍ + 0.1 ẋ + 4 x = x(t − τ): crossings out at √3-odd frequencies and back in, until out comes more often."""
    stable = stable_delays([[0.0, 1.0], [-4.0, -0.1]], UNSTABLE_WITHOUT[1])
    assert len(stable) == 3
    undamped = stable_delays([[0.0, 1.0], [-2.0, 0.0]], UNSTABLE_WITHOUT[1])
    assert undamped == (pytest.approx((0.0, np.pi / np.sqrt(3))),)  # on the axis without delay, calmed by a short one


def test_no_limit_and_no_stable_delay():
    assert stable_delays(-2 * np.eye(2), np.eye(2)) == ((0.0, np.inf),)
    assert stable_delays(-2 * np.eye(2), np.eye(2), up_to=3.0) == ((0.0, 3.0),)
    assert stable_delays(1.0, -0.5) == ()
    assert stable_delays(np.diag([1.0, -1.0]), np.zeros((2, 2))) == ()
    assert stable_delays(0.0, 0.0) == ()  # a root stays at 0
    assert stable_delays(np.diag([0.0, -1.0]), np.diag([0.0, -1.0])) == ()


def test_roots_that_only_touch_the_axis_part_intervals_without_end():
    """ẋ₁ = −x₁ + a x₂(t − τ), ẋ₂ = −x₂ − a x₁(t − τ): loop gain a² at rest is met by the phase at every turn."""
    present, delayed = np.array([[-1.0, 2.0], [-2.0, -1.0]]), np.eye(2)
    assert stable_delays(present, 0.999 * delayed) == ((0.0, np.inf),)
    with pytest.raises(IllPosedError, match="single delays without end"):
        stable_delays(present, delayed)
    touched = stable_delays(present, delayed, up_to=10.0)
    assert touched[0].high == touched[1].low == pytest.approx(np.pi, rel=1e-6)


@st.composite
def systems(draw, largest=4):
    """Small systems, of which about a third are stable without delay."""
    rng, size = draw(generators), draw(st.integers(1, largest))
    present, delayed = rng.normal(size=(2, size, size))
    return present - rng.uniform(0, 2) * np.eye(size), delayed


@given(system=systems(), faster=st.floats(0.01, 100))
@settings(max_examples=30)
def test_time_may_be_measured_in_any_unit(system, faster):
    present, delayed = system
    expected = np.array(stable_delays(present, delayed, up_to=20.0)).reshape(-1, 2) / faster
    found = np.array(stable_delays(faster * present, faster * delayed, up_to=20.0 / faster)).reshape(-1, 2)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9 / faster)


@given(system=systems(), rng=generators)
@settings(max_examples=30)
def test_coordinates_transposition_and_copies_change_nothing(system, rng):
    expected = np.array(stable_delays(*system, up_to=20.0)).reshape(-1, 2)
    basis = rng.normal(size=system[0].shape) + 3 * np.eye(len(system[0]))
    similar = [np.linalg.solve(basis, matrix @ basis) for matrix in system]
    twice = [np.kron(np.eye(2), matrix) for matrix in system]
    for same in (similar, [matrix.T for matrix in system], twice):
        found = np.array(stable_delays(*same, up_to=20.0)).reshape(-1, 2)
        np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-7)


@given(system=systems())
@settings(max_examples=30)
def test_the_eigenproblem_and_the_search_find_the_same(system):
    expected = np.array(stable_delays(*system, up_to=20.0)).reshape(-1, 2)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(delay_crossings, "LARGEST_PENCIL", 0)
        found = np.array(stable_delays(*system, up_to=20.0)).reshape(-1, 2)
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-7)


@given(system=systems(), delay=st.floats(0.01, 5.0))
@settings(max_examples=40)
def test_tdcpy_finds_the_rightmost_root_on_the_same_side(system, delay):
    tdcpy = pytest.importorskip("tdcpy", reason="an independent package for time-delay systems")
    abscissa = tdcpy.sa(tdcpy.RDDE(list(system), [0.0, delay]))
    if abs(abscissa) > 1e-6:
        stable = any(low < delay < high for low, high in stable_delays(*system))
        assert stable == (abscissa < 0)


@pytest.mark.parametrize("system", [TWO_STATES, UNSTABLE_WITHOUT, SERVO], ids=["two states", "oscillator", "servo"])
def test_tdcpy_finds_a_root_on_the_axis_at_every_end(system):
    tdcpy = pytest.importorskip("tdcpy", reason="an independent package for time-delay systems")
    ends = [end for interval in stable_delays(*system) for end in interval if end > 0]
    assert [tdcpy.sa(tdcpy.RDDE(list(system), [0.0, end])) for end in ends] == pytest.approx(
        [0.0] * len(ends), abs=1e-6
    )


@pytest.mark.parametrize(("share", "grows"), [(0.99, False), (1.01, True)])
def test_jitcdde_integrates_to_decay_below_an_end_and_growth_above(share, grows):
    """The delayed servo, 150 s: on either side of 1.167144 s by 1 % its oscillation, at 1.3 rad/s, changes slowly."""
    jitcdde = pytest.importorskip("jitcdde", reason="an independent integrator of delay differential equations")
    present, delayed = SERVO
    (stable,) = stable_delays(*SERVO)
    now, before = ([jitcdde.y(k, time) for k in range(2)] for time in (jitcdde.t, jitcdde.t - share * stable.high))
    solver = jitcdde.jitcdde(
        [sum(present[i, j] * now[j] + delayed[i, j] * before[j] for j in range(2)) for i in range(2)]
    )
    solver.constant_past([1.0, 0.0])
    solver.generate_lambdas(simplify=False)  # not compiled: runs without a compiler
    solver.integrate_blindly(stable.high, 0.1)
    sizes = [np.linalg.norm(solver.integrate(time)) for time in np.arange(50.0, 150.0, 0.5)]
    assert (max(sizes[100:]) > max(sizes[:100])) == grows
