"""δ_v for a damping ratio: the closed form, the eigenvalues and the diagram's own motion agree."""

import re
from itertools import combinations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from strategies import scenarios

from drake_formation import load_scenario, simulate
from drake_formation.analysis import linearize
from drake_formation.analysis.gains.velocity_gain import velocity_gain
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.scenario import Scenario, resolve, with_overrides

UNEQUAL = {"robots.mass": [10.0, 20.0, 40.0, 80.0], "consensus.graph": "path", "springs.stiffness": 500.0}


def at_rest(name, **changes):
    return load_scenario(name, overrides={path.replace("__", "."): value for path, value in changes.items()})


@pytest.mark.parametrize(("name", "robots"), [("line", 2), ("quadrilateral", 4), ("octagon", 8)])
@pytest.mark.parametrize("ratio", [0.2, 0.7, 1.0, 1.6])
def test_identical_robots_have_a_closed_form(name, robots, ratio):
    formation = linearize(at_rest(name, consensus__delta=1e4, springs__stiffness=0.0))
    found = velocity_gain(formation, damping_ratio=ratio)
    expected = (2 * ratio * np.sqrt(40 * (1 + robots * 1e4)) - 9) / robots
    assert found.delta_v == pytest.approx(expected, rel=1e-9)
    assert found.laplacian_eigenvalue == pytest.approx(robots)
    assert found.closed_form


STAR = Scenario.model_validate(
    {
        "name": "star",
        "formation": {"shape": "line", "robots": 4, "side": 1.0, "heading": 0.0},
        "robots": {"start": {"centre": [0, 0]}, "mass": [72.28, 21.12, 26.92, 57.36]},
        "springs": {
            "graph": [[1, 2], [1, 3], [1, 4], [2, 3], [3, 4]],
            "law": "linear",
            "stiffness": [859.26, 456.59, 341.79, 971.54, 944.26],
            "damping": [43.849, 36.619, 18.183, 41.550, 41.041],
        },
        "tracking": {"Q": 3.4522, "R": 4.4737},
        "consensus": {"graph": "star", "delta": 98.142},
        "transport": {"goal": [20, 20], "duration": 1.0},
    }
)
"""Damping turns a mode of this formation into two real eigenvalues while another still swings."""

ratios_asked = st.floats(0.05, 0.95)
several = st.integers(2, 5)


def pairs_ratios(loop):
    """Damping ratios of all pairs: of conjugates, and of every two real eigenvalues."""
    values = np.linalg.eigvals(loop)
    apparent = np.abs(values.imag) < 1e-6 * np.abs(values)  # a real one that occurs twice, to rounding
    swinging, real = values[~apparent & (values.imag > 0)], values[apparent].real
    return np.array(
        [*(-swinging.real / np.abs(swinging)), *(-(a + b) / (2 * np.sqrt(a * b)) for a, b in combinations(real, 2))]
    )


@given(scenario=scenarios(robots=several) | scenarios(isotropic=True, robots=several), ratio=ratios_asked)
@example(scenario=STAR, ratio=0.875)
@settings(max_examples=60)
def test_a_pair_of_eigenvalues_of_the_loop_has_the_ratio(scenario, ratio):
    """There always is an answer: up to critical damping a pair meets another only by an unlikely chance."""
    formation = linearize(scenario)
    found = velocity_gain(formation, damping_ratio=ratio)
    loop = formation.closed_loop(found.delta, found.delta_v)
    assert np.abs(pairs_ratios(loop) / found.damping_ratio - 1).min() < 1e-6
    values = np.linalg.eigvals(loop)
    assert found.least_damping_ratio == pytest.approx((-values.real / np.abs(values)).min())
    if found.delta_v > 0:
        assert found.damping_ratio == pytest.approx(ratio, rel=1e-6)
        assert found.without < ratio
    else:
        assert found.damping_ratio == found.without >= ratio * (1 - 1e-9)


@given(scenario=scenarios(isotropic=True, robots=several), ratio=ratios_asked)
@example(scenario=STAR, ratio=0.875)
@settings(max_examples=20)
def test_no_smaller_gain_damps_the_mode_as_much(scenario, ratio):
    """Counted on the way: as many pairs have passed the ratio as did before the mode's own, and the mode's own."""
    formation = linearize(scenario)
    found = velocity_gain(formation, damping_ratio=ratio)
    if found.delta_v == 0:
        assert found.without >= ratio * (1 - 1e-9)
        return
    below, above = (
        np.sum(pairs_ratios(formation.closed_loop(found.delta, factor * found.delta_v)) < ratio)
        for factor in (1 - 1e-6, 1 + 1e-6)
    )
    assert below > above


@given(scenario=scenarios(robots=several), ratio=st.floats(1.05, 50))
@settings(max_examples=40)
def test_beyond_critical_damping_there_is_an_answer_up_to_the_ratio_that_a_refusal_names(scenario, ratio):
    """Two real eigenvalues of different pairs may meet; a refusal names the ratio reached before, above 1."""
    formation = linearize(scenario)
    try:
        found = velocity_gain(formation, damping_ratio=ratio)
    except IllPosedError as refusal:
        reached = float(re.search(r"damping ratio ([^,]+),", str(refusal))[1])
        assert 0.99 < reached < ratio
        found = velocity_gain(formation, damping_ratio=0.99 * reached)
    ratios = pairs_ratios(formation.closed_loop(found.delta, found.delta_v))
    assert np.abs(ratios / found.damping_ratio - 1).min() < 1e-6


def test_the_mode_is_the_one_of_the_algebraic_connectivity():
    formation = linearize(at_rest("octagon", consensus__graph="path", consensus__delta=100.0, springs__stiffness=0.0))
    found = velocity_gain(formation, damping_ratio=0.6)
    connectivity = np.linalg.eigvalsh(formation.laplacian)[1]
    assert found.laplacian_eigenvalue == pytest.approx(connectivity, rel=1e-6)
    roots = np.roots([40, 9 + connectivity * found.delta_v, 1 + connectivity * 100])
    assert -roots.real[0] / abs(roots[0]) == pytest.approx(0.6, rel=1e-9)


def released(formation, delta_v, displaced, duration):
    """The diagram's motion from robots displaced from their slots (m) and at rest."""
    scenario = formation.scenario
    start = resolve(scenario).slots + np.array(scenario.transport.goal) + displaced
    changes = {
        "robots.start": start.tolist(),
        "consensus.delta_v": delta_v,
        "transport.duration": duration,
        "simulator.accuracy": 1e-10,
        "simulator.max_step_size": duration / 2000,
    }
    return simulate(with_overrides(scenario, changes))


@pytest.mark.parametrize("ratio", [0.1, 0.3])
def test_two_robots_swing_with_the_logarithmic_decrement(ratio):
    formation = linearize(at_rest("line", consensus__delta=500.0, springs__stiffness=3e4))
    found = velocity_gain(formation, damping_ratio=ratio)
    period = 2 * np.pi / (found.frequency * np.sqrt(1 - ratio**2))
    across = np.array([[1e-4, 0.0], [-1e-4, 0.0]])
    result = released(formation, found.delta_v, across, 2.2 * period)
    apart = (result.position.sel(robot=1, axis="x") - result.position.sel(robot=2, axis="x")).values
    peaks = [k for k in range(1, len(apart) - 1) if apart[k - 1] < apart[k] >= apart[k + 1]]
    decrement = np.log(apart[peaks[0]] / apart[peaks[1]])
    assert decrement == pytest.approx(2 * np.pi * ratio / np.sqrt(1 - ratio**2), rel=1e-3)
    assert result.time.values[peaks[0]] == pytest.approx(period, rel=5e-3)


@pytest.mark.parametrize("ratio", [0.1, 0.4])
def test_unequal_robots_swing_with_the_logarithmic_decrement(ratio):
    formation = linearize(load_scenario("quadrilateral", overrides={**UNEQUAL, "consensus.delta": 2e3}))
    found = velocity_gain(formation, damping_ratio=ratio)
    assert not found.closed_form
    values, vectors = np.linalg.eig(formation.closed_loop(found.delta, found.delta_v))
    nearness = np.abs(-values.real / np.abs(values) - ratio) + np.abs(np.abs(values) / found.frequency - 1)
    mode = int(np.argmin(nearness))
    shape = vectors[:, mode].real.reshape(-1, 4)[:, :2]
    period = 2 * np.pi / abs(values[mode].imag)
    result = released(formation, found.delta_v, 1e-5 * shape / np.abs(shape).max(), 2 * period)
    state = np.concatenate([result.position - result.goal - result.slot, result.velocity], axis=-1)
    amplitude = np.abs(state.reshape(len(state), -1) @ np.linalg.inv(vectors)[mode])
    middle = int(np.argmin(np.abs(result.time.values - period)))
    decrement = np.log(amplitude[middle] / amplitude[-1]) * period / (2 * period - result.time.values[middle])
    assert decrement == pytest.approx(2 * np.pi * ratio / np.sqrt(1 - ratio**2), rel=2e-3)


def test_a_mode_that_is_damped_enough_needs_nothing():
    found = velocity_gain(linearize(load_scenario("line")), damping_ratio=0.7)
    assert (found.delta_v, found.closed_form) == (0.0, True)
    assert found.damping_ratio == pytest.approx(9 / (2 * np.sqrt(40)))


def test_more_damping_takes_more_gain():
    formation = linearize(load_scenario("quadrilateral", overrides={**UNEQUAL, "consensus.delta": 1e3}))
    gains = [velocity_gain(formation, damping_ratio=ratio).delta_v for ratio in (0.1, 0.3, 0.5, 0.7, 0.9, 1.0)]
    assert np.all(np.diff(gains) > 0)


@pytest.mark.parametrize(
    ("scenario", "ratio", "words"),
    [
        (
            at_rest("line", formation={"shape": "slots", "slots": [[0, 0]]}, robots__start={"centre": [2.5, 3.5]}),
            0.7,
            "one robot",
        ),
        (at_rest("line"), 0.0, "above 0"),
        (at_rest("line"), -0.5, "above 0"),
        (at_rest("line"), 1e300, "at most 1000"),
        (at_rest("line"), float("inf"), "at most 1000"),
        (at_rest("line"), float("nan"), "above 0"),
    ],
)
def test_questions_without_an_answer_say_so(scenario, ratio, words):
    with pytest.raises(IllPosedError, match=words):
        velocity_gain(linearize(scenario), damping_ratio=ratio)
