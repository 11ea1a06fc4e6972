"""Delay margins: known answers, independent computations, and the diagram's blocks simulated with delayed channels."""

import numpy as np
import pytest
from channels import OpenChannels
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq
from strategies import generators, scenarios

from drake_formation import build_diagram, load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.delay_margin import DelayMargin, delay_margin, delay_parts
from drake_formation.lowering import lower

KINDS = ["neighbour", "relative"]
several = st.integers(2, 3)


def formation(name="line", **overrides):
    return linearize(load_scenario(name, overrides={path.replace("__", "."): v for path, v in overrides.items()}))


def polygon(robots, **overrides):
    shape = {"shape": "polygon", "robots": robots, "side": 1.0}
    return formation(formation=shape, robots__start={"centre": [0.0, 0.0]}, **overrides)


# Closed forms for identical robots whose object has no stiffness: m s² + (d + δ_v a) s + (k + δ a) = (δ + δ_v s) b z,
# a what acts at once of the Laplacian's eigenvalue and b the rest, with z = e^{−sτ}.


def second_order_margin(mass, damping, stiffness, delta, delta_v, at_once, late):
    """Least τ of a mode, from |left| = |right|, a quadratic in ω²; infinity where there is none."""
    c, k = damping + delta_v * at_once, stiffness + delta * at_once
    squares = np.roots([mass**2, c**2 - 2 * mass * k - (delta_v * late) ** 2, k**2 - (delta * late) ** 2])
    delays = [np.inf]
    for w in np.sqrt(squares[(abs(squares.imag) < 1e-9 * abs(squares)) & (squares.real > 0)].real):
        z = (-mass * w**2 + 1j * c * w + k) / ((delta + 1j * w * delta_v) * late)
        delays.append(-np.angle(z) % (2 * np.pi) / w)
    return min(delays)


@given(
    robots=st.integers(2, 6),
    graph=st.sampled_from(["complete", "cycle"]),
    delta=st.floats(0.1, 1e4),
    delta_v=st.just(0.0) | st.floats(0.1, 1e3),
)
@settings(max_examples=25)
def test_identical_robots_follow_the_closed_form(robots, graph, delta, delta_v):
    loop = polygon(robots, springs__stiffness=0.0, consensus={"graph": graph, "delta": delta, "delta_v": delta_v})
    degree = loop.laplacian[0, 0]
    relative = [(0.0, -v) for v in np.linalg.eigvalsh(loop.laplacian) if v > 1e-9]
    neighbour = [(degree, v) for v in np.linalg.eigvalsh(degree * np.eye(robots) - loop.laplacian) if abs(v) > 1e-9]
    for of, modes in (("relative", relative), ("neighbour", neighbour)):
        expected = min(second_order_margin(40.0, 9.0, 1.0, delta, delta_v, a, b) for a, b in modes)
        found = delay_margin(loop, of=of).delay_s
        assert (np.inf if found is None else found) == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(("name", "robots"), [("line", 2), ("quadrilateral", 4), ("octagon", 8)])
@pytest.mark.parametrize("delta", [1e4, 2e4])
@pytest.mark.parametrize("stiffness", [1.45, 3e4])
def test_the_papers_gains_leave_the_damping_over_the_stiffness(name, robots, delta, stiffness):
    """d/(N δ) and d/δ, whatever the object: a square and an octagon can turn, and steel does not stop that."""
    loop = formation(name, consensus__delta=delta, springs__stiffness=stiffness)
    assert delay_margin(loop, of="relative").delay_s == pytest.approx(9 / (robots * delta), rel=1e-3)
    assert delay_margin(loop, of="neighbour").delay_s == pytest.approx(9 / delta, rel=1e-3)


def test_enough_velocity_consensus_outweighs_whatever_the_neighbours_say_late():
    """Common motion is the last to be safe, from d² + 2 d δ_v N' ≥ 2 m (k + δ N') − 2 m √(k² + 2 k δ N') on."""
    others, delta = 3, 50.0
    pull = 1 + delta * others
    enough = (80 * (pull - np.sqrt(1 + 2 * delta * others)) - 81) / (18 * others)
    loop = polygon(4, springs__stiffness=0.0)
    assert delay_margin(loop, delta=delta, delta_v=0.99 * enough).delay_s is not None
    assert delay_margin(loop, delta=delta, delta_v=1.01 * enough).delay_s is None
    assert delay_margin(loop, of="relative", delta=delta, delta_v=1.01 * enough).delay_s is not None


def test_too_much_velocity_consensus_is_single_integrators_in_consensus_again():
    loop = polygon(4, springs__stiffness=0.0)
    margin = delay_margin(loop, of="relative", delta=1.0, delta_v=1e5)
    assert margin.delay_s == pytest.approx(np.pi * 40 / (2 * 4 * 1e5), rel=1e-3)


def test_weak_consensus_tolerates_every_delay():
    """While λ (δ² + ω² δ_v²)^½ stays below what the local LQR resists with, at any frequency."""
    loop = polygon(3, springs__stiffness=0.0)
    frequencies = np.linspace(0, 1, 100001)
    least_resistance = np.abs(1 - 40 * frequencies**2 + 9j * frequencies)
    limit = least_resistance.min() / 3
    assert delay_margin(loop, of="relative", delta=0.99 * limit).delay_s is None
    assert delay_margin(loop, of="relative", delta=1.01 * limit).delay_s is not None


def test_a_longer_delay_may_be_stable_again():
    """Weak virtual springs: on either side of every end, roots of the whole loop say so."""
    loop = formation(consensus__delta=3.0, consensus__delta_v=1.0)
    margin = delay_margin(loop)
    assert margin.stable_s[0] == (0.0, margin.delay_s)
    assert len(margin.stable_s) == 3
    for low, high in margin.stable_s[1:]:
        for delay, side in ((0.99 * low, 1), (1.01 * low, -1), (0.99 * high, -1), (1.01 * high, 1)):
            assert side * rightmost(*delay_parts(loop, "neighbour", 3.0, 1.0), delay, points=40) > 0
    assert "stable again from 10.76 to 16.63 s and from 24.92 to 27.16 s" in margin.meaning()
    assert margin.to_dict()["again_stable_s"] == [list(each) for each in margin.stable_s[1:]]


def test_delayed_neighbours_drag_on_the_common_motion_and_relative_delay_does_not():
    loop, delay = polygon(8, springs__stiffness=0.0, consensus__delta=1e4), 0.0008
    together = np.kron(np.ones(8), [1.0, 0.0, 0.0, 0.0]), np.kron(np.ones(8), [0.0, 0.0, 1.0, 0.0])

    def characteristic(s, of):
        present, delayed = delay_parts(loop, of, loop.delta, loop.delta_v)
        A = present + delayed * np.exp(-s * delay)
        return np.linalg.det(s * np.eye(2) - [[v @ A @ w / 8 for w in together] for v in together])

    own_pace = np.linalg.eigvals(loop.tracking)[0]
    assert characteristic(own_pace, "relative") == pytest.approx(0.0, abs=1e-12)
    slowed = brentq(characteristic, -0.05, 0.0, args=("neighbour",))
    assert slowed == pytest.approx(-1 / (9 + 7e4 * delay), rel=0.02)


@given(scenario=scenarios(robots=several), of=st.sampled_from(KINDS))
@settings(max_examples=15)
def test_blocks_have_the_margin_of_the_whole(scenario, of):
    """The quadratic eigenproblem of all states at once, with generalized eigenvalues z as the literature states it."""
    from scipy.linalg import eig

    loop = linearize(scenario)
    present, delayed = delay_parts(loop, of, loop.delta, loop.delta_v)
    n, one = len(present), np.eye(len(present))
    zero, unit = np.zeros((n * n, n * n)), np.eye(n * n)
    square, linear, free = np.kron(one, delayed), np.kron(one, present) + np.kron(present, one), np.kron(delayed, one)
    left, right = np.block([[linear, free], [unit, zero]]), np.block([[-square, zero], [zero, unit]])
    z = eig(left, right, right=False)
    delays = []
    for value in z[np.isfinite(z) & (np.abs(np.abs(z) - 1) < 1e-5)]:
        roots = np.linalg.eigvals(present + value / abs(value) * delayed)
        w = roots[np.argmin(np.abs(roots.real))].imag
        delays.append((-np.angle(value) * np.sign(w) % (2 * np.pi)) / abs(w))
    margin = delay_margin(loop, of=of)
    if margin.delay_s is None:
        assert not delays
    else:
        assert margin.delay_s == pytest.approx(min(delays), rel=1e-4)
        assert margin.phase_rad == pytest.approx(margin.delay_s * margin.frequency_rad_s)


@given(scenario=scenarios(robots=several), of=st.sampled_from(KINDS), seed=generators)
@settings(max_examples=15)
def test_no_root_reaches_the_axis_at_a_shorter_delay(scenario, of, seed):
    loop = linearize(scenario)
    present, delayed = delay_parts(loop, of, loop.delta, loop.delta_v)
    margin = delay_margin(loop, of=of)
    limit = margin.delay_s or 10.0
    for delay in limit * seed.uniform(0, 0.999, 5):
        assert rightmost(present, delayed, delay) < 0
    if margin.delay_s is not None:
        s = 1j * margin.frequency_rad_s
        singular = np.linalg.svd(s * np.eye(len(present)) - present - delayed * np.exp(-s * limit), compute_uv=False)
        assert singular[-1] < 1e-8 * singular[0]


def rightmost(present, delayed, delay, points=20):
    """Rightmost root by Chebyshev collocation of the solution's history (Breda, Maset and Vermiglio 2005)."""
    n, nodes = len(present), np.cos(np.pi * np.arange(points + 1) / points)
    weights = np.where(np.isin(np.arange(points + 1), [0, points]), 2.0, 1.0) * (-1.0) ** np.arange(points + 1)
    gaps = nodes[:, None] - nodes + np.eye(points + 1)
    matrix = np.outer(weights, 1 / weights) / gaps
    derivative = (matrix - np.diag(matrix.sum(axis=1))) * 2 / delay
    whole = np.kron(derivative, np.eye(n))
    whole[:n] = 0
    whole[:n, :n], whole[:n, -n:] = present, delayed
    return np.linalg.eigvals(whole).real.max()


# The diagram's own blocks with delayed channels, integrated by the method of steps.

PAPER = ("line", {"consensus__delta": 1e4})
CASES = [
    PAPER,
    ("line", {"consensus__delta": 2e4, "springs__stiffness": 3e4, "consensus__delta_v": 600.0}),
    ("quadrilateral", {"consensus__delta": 1e4, "springs__stiffness": 3e4}),
    ("quadrilateral", {"consensus__delta": 1e3, "consensus__delta_v": 300.0, "consensus__graph": "path"}),
]


def test_the_opened_diagram_without_delay_is_the_diagram():
    loop = formation("quadrilateral", consensus__delta=100.0, consensus__delta_v=20.0, springs__stiffness=300.0)
    robots, whole = OpenChannels(loop.scenario), lower(build_diagram(loop.scenario))
    values = whole.read(whole.diagram.CreateDefaultContext())
    state = robots.rest + np.random.default_rng(0).normal(scale=0.1, size=16)
    pulls = robots.channel_forces(*(state.reshape(-1, 4)[ends] for ends in (robots.to, robots.of)))
    expected = whole.derivatives(0.0, state, values)
    np.testing.assert_allclose(robots.derivatives(state, robots.forces(pulls)), expected, rtol=1e-9, atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("of", KINDS)
@pytest.mark.parametrize("case", CASES, ids=["line", "steel line", "steel square", "square in a row"])
def test_simulation_decays_below_the_margin_and_grows_above(case, of):
    loop = formation(case[0], **case[1])
    margin = delay_margin(loop, of=of)
    robots = OpenChannels(loop.scenario)
    below, above = (growth(robots, loop, margin, share * margin.delay_s) for share in (0.95, 1.05))
    assert below == pytest.approx(expected_growth(loop, margin, 0.95), rel=0.02)
    assert above == pytest.approx(expected_growth(loop, margin, 1.05), rel=0.02)
    assert below < 0 < above


def critical_root(loop, margin, delay):
    """The root that crosses at the margin, and its vector, at another delay: Newton's method on s I − A₀ − A₁ e^{−sτ}.

    The delay goes there in steps, for the root to be the same one.
    """
    present, delayed = delay_parts(loop, margin.of, loop.delta, loop.delta_v)
    s = 1j * margin.frequency_rad_s
    for share in np.linspace(1, delay / margin.delay_s, 6):
        for _ in range(8):
            late = delayed * np.exp(-s * share * margin.delay_s)
            values, vectors = np.linalg.eig(present + late)
            k = np.argmin(np.abs(values - s))
            left = np.linalg.inv(vectors)[k]
            s = s + (values[k] - s) / (1 + share * margin.delay_s * left @ late @ vectors[:, k])
    return s, vectors[:, k]


def expected_growth(loop, margin, share):
    return critical_root(loop, margin, share * margin.delay_s)[0].real


def growth(robots, loop, margin, delay, periods=8):
    """Growth rate (1/s) of the oscillation that the formation begins with, in its own nonlinear blocks."""
    root, shape = critical_root(loop, margin, delay)
    period = 2 * np.pi / abs(root.imag)
    back = int(np.ceil(delay / (0.008 * period)))
    step = delay / back
    per_period = round(period / step)

    def history(time):
        return robots.rest + 1e-5 * (shape * np.exp(root * time)).real

    states = [history(step * k) for k in range(-back, 1)]
    slopes = [1e-5 * (root * shape * np.exp(root * step * k)).real for k in range(-back, 1)]

    def rate(state, late):
        own = (state if margin.of == "neighbour" else late).reshape(-1, 4)[robots.to]
        pulls = robots.channel_forces(own, late.reshape(-1, 4)[robots.of])
        return robots.derivatives(state, robots.forces(pulls))

    slopes[-1] = rate(states[-1], states[0])
    for _ in range(periods * per_period):
        now, then, next_ = states[-1], states[-1 - back], states[-back]
        between = (then + next_) / 2 + step / 8 * (slopes[-1 - back] - slopes[-back])
        first = slopes[-1]
        second = rate(now + step / 2 * first, between)
        third = rate(now + step / 2 * second, between)
        fourth = rate(now + step * third, next_)
        states.append(now + step / 6 * (first + 2 * second + 2 * third + fourth))
        slopes.append(rate(states[-1], next_))
    moved = np.array(states[back:]) - robots.rest
    sizes = [np.linalg.norm(part) for part in (moved[:per_period], moved[-per_period:])]
    return np.log(sizes[1] / sizes[0]) / (step * (len(moved) - per_period))


def test_ill_posed_questions_are_refused():
    alone = {"shape": "line", "robots": 1, "side": 1.0}
    single = formation(formation=alone, robots__start={"centre": [0.0, 0.0]})
    with pytest.raises(IllPosedError, match="at least two robots"):
        delay_margin(single)
    with pytest.raises(ValueError, match="neighbour, relative"):
        delay_margin(formation(), of="own")
    with pytest.raises(ValueError, match="not negative"):
        delay_margin(formation(), delta=-1.0)


def test_without_consensus_no_delay_matters():
    margin = delay_margin(formation(), delta=0.0)
    assert margin.delay_s is None
    assert margin.meaning() == "nothing is communicated, so no delay matters"


def test_it_says_what_it_means_and_gives_plain_values():
    margin = delay_margin(formation(consensus__delta=1e4), of="relative")
    assert margin.meaning().startswith("differences to neighbours must be younger than 0.45 ms")
    assert "hardly any lag" in margin.meaning()
    assert set(margin.to_dict()) >= {"of", "delay_s", "frequency_rad_s"}
    assert type(margin.to_dict()["delay_s"]) is float
    assert "any age" in DelayMargin("relative", 1.0, 0.0, None, None, None, ((0.0, np.inf),)).meaning()
