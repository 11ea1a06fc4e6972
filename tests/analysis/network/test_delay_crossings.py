"""The delay eigenvalue problem against known answers, and against the search that larger systems take."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import generators

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.delay_branch_and_bound import search
from drake_formation.analysis.network.delay_crossings import first_crossing
from drake_formation.formation import graphs


@given(rate=st.floats(1e-3, 1e3))
def test_scalar(rate):
    """ẋ = −a x(t − τ) is stable until τ = π/(2a), and then oscillates at a."""
    crossing = first_crossing(np.zeros((1, 1)), np.array([[-rate]]))
    assert crossing.delay == pytest.approx(np.pi / 2 / rate, rel=1e-12)
    assert crossing.frequency == pytest.approx(rate, rel=1e-12)


@given(decay=st.floats(-5, 5), rate=st.floats(0.1, 5))
def test_scalar_with_a_part_at_once(decay, rate):
    """ẋ = −a x − b x(t − τ): ω = √(b² − a²), cos(ωτ) = −a/b; stable for every delay where a ≥ b."""
    if abs(abs(decay) - rate) < 1e-3:
        return
    parts = np.array([[-decay]]), np.array([[-rate]])
    if decay + rate < 0:
        with pytest.raises(IllPosedError, match="even without delay"):
            first_crossing(*parts)
    elif decay > rate:
        assert first_crossing(*parts) is None
    else:
        frequency = np.sqrt(rate**2 - decay**2)
        assert first_crossing(*parts).delay == pytest.approx(np.arccos(-decay / rate) / frequency, rel=1e-8)


@pytest.mark.parametrize(
    ("topology", "robots"), [("complete", 4), ("path", 7), ("cycle", 6), ("star", 5), ("path", 14)]
)
def test_single_integrators_in_consensus(topology, robots):
    """q̇ = −L q(t − τ) about its mean: π/(2 λ_max) (Olfati-Saber and Murray 2004)."""
    laplacian = graphs.laplacian(graphs.graph(topology, robots))
    mean = np.ones((robots, robots)) / robots
    assert first_crossing(-mean, -laplacian).delay == pytest.approx(np.pi / 2 / np.linalg.eigvalsh(laplacian)[-1])


@given(mass=st.floats(0.5, 50), damping=st.floats(0.01, 20), stiffness=st.floats(1, 1e4))
def test_oscillator_with_a_late_spring(mass, damping, stiffness):
    """m q̈ + d q̇ + k q(t − τ): cos(ωτ) = m ω²/k, sin(ωτ) = d ω/k."""
    square = (-(damping**2) + np.sqrt(damping**4 + 4 * mass**2 * stiffness**2)) / (2 * mass**2)
    phase = np.arctan2(damping * np.sqrt(square), mass * square)
    crossing = first_crossing(
        np.array([[0.0, 1.0], [0.0, -damping / mass]]), np.array([[0.0, 0.0], [-stiffness / mass, 0.0]])
    )
    assert crossing.frequency == pytest.approx(np.sqrt(square), rel=1e-8)
    assert crossing.delay == pytest.approx(phase / np.sqrt(square), rel=1e-8)


def test_a_root_that_comes_back_to_the_axis_first_leaves_it():
    """The least of several crossings, in a system whose later ones are stable windows: ẍ + 0.1 ẋ + 4 x = x(t − τ)."""
    present, delayed = np.array([[0.0, 1.0], [-4.0, -0.1]]), np.array([[0.0, 0.0], [1.0, 0.0]])
    crossing = first_crossing(present, delayed)
    delays = np.linspace(1e-3, 20, 200001)
    w = np.roots([1, 0.01 - 8, 15])
    candidates = [(-np.angle(4 - u + 0.1j * np.sqrt(u))) % (2 * np.pi) / np.sqrt(u) for u in w]
    assert crossing.delay == pytest.approx(min(candidates), rel=1e-9)
    assert crossing.delay < delays[-1]


def test_what_is_not_delayed_and_what_does_not_matter():
    assert first_crossing(-np.eye(2), np.zeros((2, 2))) is None
    assert first_crossing(-2 * np.eye(2), np.eye(2)) is None


@given(rng=generators, size=st.integers(1, 6))
@settings(max_examples=60)
def test_search_and_eigenproblem_agree(rng, size):
    present, delayed = rng.normal(size=(2, size, size))
    present = present - np.eye(size) * (np.linalg.eigvals(present + delayed).real.max() + rng.uniform(0.01, 1.5))
    exact, found = first_crossing(present, delayed), search(present, delayed)
    if exact is None:
        assert found is None
    else:
        assert found.delay == pytest.approx(exact.delay, rel=2e-6)
        assert found.frequency == pytest.approx(exact.frequency, rel=1e-6)


def test_the_search_leaves_longer_delays_aside():
    present, delayed = np.zeros((12, 12)), -np.diag(np.arange(1.0, 13.0))
    assert search(present, delayed).delay == pytest.approx(np.pi / 24)
    assert search(present, delayed, below=0.1) is None


@given(rng=generators)
@settings(max_examples=20)
def test_a_crossing_solves_the_equation(rng):
    present, delayed = rng.normal(size=(2, 5, 5))
    present = present - np.eye(5) * (np.linalg.eigvals(present + delayed).real.max() + 0.1)
    crossing = first_crossing(present, delayed)
    if crossing is not None:
        s = 1j * crossing.frequency
        residual = (s * np.eye(5) - present - delayed * np.exp(-s * crossing.delay)) @ crossing.shape
        np.testing.assert_allclose(residual, 0, atol=1e-9 * np.linalg.norm(present))
