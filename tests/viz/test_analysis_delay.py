"""The figure of the delay margin shows the margins."""

import numpy as np
import pytest

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.delay_margin import delay_margin
from drake_formation.viz.analysis_delay import curve, delay_margin_against_delta, margins

DELTAS = [0.1, 10.0, 1e3]


@pytest.fixture(scope="module")
def formation():
    return linearize(load_scenario("line", overrides={"consensus.delta": 1e3, "consensus.delta_v": 50.0}))


@pytest.fixture(scope="module")
def axes(formation):
    return delay_margin_against_delta(formation, deltas=DELTAS, velocity_gains=[0.0, 50.0])


def test_lines_are_the_margins(formation, axes):
    expected = [
        [delay_margin(formation, of=of, delta=delta, delta_v=delta_v).delay_s for delta in DELTAS]
        for delta_v in (0.0, 50.0)
        for of in ("neighbour", "relative")
    ]
    for line, delays in zip(axes.lines, expected, strict=False):
        np.testing.assert_array_equal(line.get_xdata(), DELTAS)
        np.testing.assert_allclose(line.get_ydata(), 1e3 * np.array(delays, dtype=float))


def test_where_every_delay_is_tolerated_there_is_no_line(axes):
    assert np.isnan(axes.lines[1].get_ydata()[0])


def test_rings_mark_the_scenarios_own_gains(formation, axes):
    for ring, of in zip(axes.lines[4:], ("neighbour", "relative"), strict=True):
        assert ring.get_xdata()[0] == 1e3
        assert ring.get_ydata()[0] == pytest.approx(1e3 * delay_margin(formation, of=of).delay_s)


def test_axes_are_logarithmic_and_have_units(axes):
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert "(N/m)" in axes.get_xlabel()
    assert "(ms)" in axes.get_ylabel()


def test_by_default_the_papers_gains_and_the_scenarios_are_drawn(formation):
    axes = delay_margin_against_delta(formation)
    assert axes.get_xlim()[1] >= 2e4
    assert len(axes.lines) == 2 * 4 + 2


def test_one_robot_is_refused():
    alone = {"formation": {"shape": "line", "robots": 1, "side": 1.0}, "robots.start": {"centre": [0.0, 0.0]}}
    with pytest.raises(IllPosedError):
        delay_margin_against_delta(linearize(load_scenario("line", overrides=alone)))


SHAKEN = {
    "robots.mass": [72.28, 21.12, 26.92, 57.36],
    "springs.law": "linear",
    "springs.graph": [[1, 2], [1, 3], [1, 4], [2, 3], [3, 4]],
    "springs.stiffness": [859.26, 456.59, 341.79, 971.54, 944.26],
    "springs.damping": [43.849, 36.619, 18.183, 41.550, 41.041],
    "consensus.graph": "star",
}


@pytest.mark.parametrize("of", ["neighbour", "relative"])
@pytest.mark.parametrize("delta_v", [0.0, 100.0])
def test_a_curve_of_few_margins_is_the_curve(of, delta_v):
    """Its points are margins, and so are those between, but in the few intervals where it jumps or ends."""
    formation = linearize(load_scenario("quadrilateral", overrides=SHAKEN))
    deltas, delays = curve(formation, of, delta_v, 1.0, 2e4)
    assert (deltas[0], deltas[-1]) == pytest.approx((1.0, 2e4))
    assert len(deltas) <= 30
    between = np.sqrt(deltas[:-1] * deltas[1:])
    np.testing.assert_allclose(delays[::5], margins(formation, of, deltas[::5].tolist(), delta_v))
    drawn = np.sqrt(delays[:-1] * delays[1:])
    exact = margins(formation, of, between.tolist(), delta_v)
    near = np.isclose(drawn, exact, rtol=0.08, equal_nan=True)
    assert np.sum(~near) <= 3
