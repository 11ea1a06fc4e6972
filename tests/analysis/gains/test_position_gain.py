"""The smallest δ: the formula where there is one, what it promises, and plain answers where there is none."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis.gains.position_gain import smallest_delta
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import linearize
from drake_formation.analysis.stability.modes import modes, movable
from drake_formation.scenario import with_overrides

# K_l = [1 0 41 0; 0 1 0 41]: overdamped, so that δ can hasten the slow pole up to d/2m = 41/80.
SLUGGISH = {"tracking.Q": [1.0, 1.0, 41.0**2 - 80.0, 41.0**2 - 80.0], "springs.graph": []}


def formation_of(name, **overrides):
    return linearize(load_scenario(name, overrides=overrides))


@pytest.mark.parametrize("graph", ["complete", "cycle", "path", "star"])
@pytest.mark.parametrize("rate", [0.03, 0.2, 0.5])
def test_decay_of_an_overdamped_loop_by_formula(graph, rate):
    """m a² − d a + p + λ₂ δ = 0 at the requested rate a."""
    formation = formation_of("quadrilateral", **{**SLUGGISH, "consensus.graph": graph, "consensus.delta": 7.0})
    connectivity = np.linalg.eigvalsh(formation.laplacian)[1]
    found = smallest_delta(formation, decay_rate=rate)
    assert found.delta == pytest.approx((41 * rate - 40 * rate**2 - 1) / connectivity, rel=1e-6)
    certified = modes(linearize(with_overrides(formation.scenario, {"consensus.delta": found.delta})))
    relative = [mode.decay_rate for mode in certified.modes if mode.moved_by_consensus]
    assert min(relative) == pytest.approx(rate, rel=1e-6)


def test_no_delta_decays_faster_than_d_over_2m():
    found = smallest_delta(formation_of("line"), decay_rate=0.12)
    assert found.delta is None
    assert "0.1125 1/s" in found.reason
    assert "consensus.delta_v" in found.reason
    assert found.best_decay_rate == pytest.approx(9 / 80, rel=1e-5)


def test_d_over_2m_itself_is_met_without_consensus():
    assert smallest_delta(formation_of("line"), decay_rate=9 / 80).delta == 0


def test_damping_bought_with_delta_v_is_lost_to_delta():
    """ζ = (d + δ_v λ) / (2 √(m (p + δ λ))) falls with δ: 0 is the smallest, or none is."""
    formation = formation_of("line", **{"springs.graph": [], "consensus.delta_v": 20.0})
    best = min(1.0, (9 + 40) / (2 * np.sqrt(40)))
    assert smallest_delta(formation, damping_ratio=best).delta == 0
    little = formation_of("line", **{"springs.graph": []})
    found = smallest_delta(little, damping_ratio=0.8)
    assert found.delta is None
    assert found.best_damping_ratio == pytest.approx(9 / (2 * np.sqrt(40)), rel=1e-6)


@given(scenario=scenarios(), ratio=st.floats(0.01, 1), share=st.floats(0.01, 2))
@settings(max_examples=10)
def test_the_answer_keeps_its_promise(scenario, ratio, share):
    formation = linearize(scenario)
    if formation.robots == 1:
        with pytest.raises(IllPosedError, match="two robots"):
            smallest_delta(formation, damping_ratio=ratio)
        return
    rate = share * modes(formation).decay_limit
    found = smallest_delta(formation, damping_ratio=ratio, decay_rate=rate)
    space = movable(formation)
    for delta in [0.0, 1.0, 100.0] if found.delta is None else [found.delta]:
        values = np.linalg.eigvals(space.T @ formation.closed_loop(delta, formation.delta_v) @ space)
        damped = (-values.real / np.abs(values)).min() >= ratio * (1 - 1e-6)
        assert (damped and -values.real.max() >= rate * (1 - 1e-6)) == (found.delta is not None)


@pytest.mark.parametrize(
    "request_",
    [
        {},
        {"damping_ratio": 0.0},
        {"damping_ratio": 1.1},
        {"decay_rate": -1.0},
        {"damping_ratio": 1e-300},
        {"decay_rate": 1e-300},
    ],
)
def test_no_request_is_refused(request_):
    with pytest.raises(IllPosedError):
        smallest_delta(formation_of("line"), **request_)


@pytest.mark.filterwarnings("error")
def test_however_small_a_damping_ratio_is_asked_for_nothing_overflows():
    for ratio in (5e-324, 1e-300, 1e-160):
        with pytest.raises(IllPosedError, match="1e-09"):
            smallest_delta(formation_of("line"), damping_ratio=ratio)
    for ratio in (1e-9, 1e-3):
        assert smallest_delta(formation_of("line"), damping_ratio=ratio).delta == 0
