import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import load_scenario, simulate
from drake_formation.analysis import certify
from drake_formation.parts.avoidance.khatib import avoidance_force
from drake_formation.parts.avoidance.rotational import rotational_force

coordinates = st.floats(-2, 2)
angles = st.floats(-np.pi / 2, np.pi / 2)
FIELD = (1.3, 31.56)


def turned(dx, dy, radius, angle):
    return rotational_force(dx, dy, radius, FIELD[0], np.cos(angle), np.sin(angle), FIELD[1])


@given(st.floats(0.35, 2), coordinates, angles)
def test_it_is_khatibs_force_turned(dx, dy, angle):
    fx, fy = avoidance_force(dx, dy, 0.3, *FIELD)
    expected = complex(fx, fy) * np.exp(1j * angle)
    assert complex(*turned(dx, dy, 0.3, angle)) == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(st.floats(0.35, 2), coordinates)
def test_a_quarter_turn_is_the_vortex_field_of_the_potential(dx, dy):
    def potential(x, y):
        clearance = np.hypot(x, y) - 0.3
        return FIELD[1] / 2 * max(1 / clearance - 1 / FIELD[0], 0) ** 2

    step = 1e-6
    slope_x = (potential(dx + step, dy) - potential(dx - step, dy)) / (2 * step)
    slope_y = (potential(dx, dy + step) - potential(dx, dy - step)) / (2 * step)
    size = np.hypot(slope_x, slope_y)
    assert turned(dx, dy, 0.3, np.pi / 2) == pytest.approx((slope_y, -slope_x), rel=1e-3, abs=1e-4 * (1 + size))


@given(coordinates, coordinates)
def test_nothing_is_felt_out_of_range(dx, dy):
    away = 1.6 * (1 + 1e-9) / max(np.hypot(dx, dy), 1e-9)
    assert np.hypot(dx, dy) < 1e-9 or turned(dx * away, dy * away, 0.3, 1.0) == (0.0, 0.0)


def head_on(**avoidance):
    """A robot on its way along the x axis to (12, 0), straight at an obstacle."""
    overrides = {
        "formation": {"shape": "line", "robots": 1, "side": 1.0},
        "robots.start": {"centre": [0.0, 0.0]},
        "tracking": {"Q": 100.0},
        "transport": {"goal": [12.0, 0.0], "duration": 30.0},
        "aggregation.duration": 0.0,
        "avoidance": {"obstacles": [{"position": [5.0, 0.0], "radius": 0.3}], **avoidance},
    }
    return load_scenario("line", overrides=overrides)


@pytest.mark.parametrize("angle", [-75.0, -30.0, 30.0, 60.0])
def test_it_gets_past_what_khatib_stalls_at(angle):
    stalled = simulate(head_on(kind="khatib"), engine="compiled")["position"].values[-1, 0]
    assert stalled[0] < 5.0
    assert stalled[1] == pytest.approx(0.0, abs=1e-9)
    passed = simulate(head_on(kind="rotational", angle=angle), engine="compiled")["position"].values[:, 0]
    np.testing.assert_allclose(passed[-1], [12.0, 0.0], atol=0.1)
    beside = passed[np.abs(passed[:, 0] - 5.0).argmin(), 1]
    assert np.sign(beside) == -np.sign(angle)  # counter-clockwise round it is below, from the left


@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    scenario = head_on(kind="rotational")
    scenario = scenario.model_copy(update={"transport": scenario.transport.model_copy(update={"duration": 8.0})})
    found, blocks = (simulate(scenario, engine=name)["position"].values[-1] for name in (engine, "blocks"))
    np.testing.assert_allclose(found, blocks, rtol=0, atol=1e-3)


def test_without_a_turn_it_is_khatib():
    beside = {"obstacles": [{"position": [5.0, 0.2], "radius": 0.3}]}
    fields = ({"kind": "khatib"}, {"kind": "rotational", "angle": 0.0})
    ends = [simulate(head_on(**field, **beside), engine="compiled")["position"].values[-1] for field in fields]
    np.testing.assert_allclose(*ends, rtol=0, atol=1e-6)


def test_it_is_analysed_out_of_range():
    assert certify(head_on(kind="rotational")).stable
