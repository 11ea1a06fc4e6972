"""A run at a glance."""

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.viz.ages import ages
from drake_formation.viz.figures import overview

QUICK = {"aggregation.duration": 1.0, "transport.duration": 3.0, "consensus.delta": 20.0, "consensus.delta_v": 20.0}


@pytest.fixture(scope="module")
def result():
    channel = {"kind": "packets", "period": 0.05, "delay": 0.1, "outages": {"1-2": [[1.5, 2.5]]}}
    return simulate(load_scenario("quadrilateral", overrides=QUICK | {"consensus.channel": channel}), engine="compiled")


def test_an_outage_is_seen_as_age(result):
    times = np.array([1.4, 2.4, 3.9])
    names = result["channel"].values.tolist()
    found = ages(result, times)
    assert found[names.index("1-2"), 1] == pytest.approx(0.1 + 0.9, abs=0.11)
    np.testing.assert_allclose(found[names.index("2-1")], 0.1, atol=0.051)
    assert (found >= 0.1 - 1e-9).all()


def test_channels_have_a_row_each_where_they_carry_packets(result):
    assert [len(axes.get_yticks()) for axes in overview(result)[2:3]] == [12]
    plain = simulate(load_scenario("quadrilateral", overrides=QUICK), engine="compiled")
    assert len(overview(plain)) == 2
    assert len(overview([plain, result])) == 3
