"""What the analysis is not of is refused with the reason, and asked of a part it answers with that part's own."""

import pytest

from drake_formation import load_scenario
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.analysis.linear.assumptions import local_lqr, require_consensus, same_lqr
from drake_formation.scenario import resolve


def weighing(there, back):
    two = [{"speaker": 1, "listener": 2, "weight": there}, {"speaker": 2, "listener": 1, "weight": back}]
    return [*two, [2, 3], [3, 4]]


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"consensus.delta": [1.0, 2.0, 2.0, 2.0]}, "robots have different consensus.delta or delta_v"),
        ({"consensus.graph": [[1, 2], [2, 3], {"speaker": 3, "listener": 4}]}, "channels go one way"),
        ({"consensus.law": ["linear", "hookean", "linear", "linear"]}, r"robots have different consensus\.law"),
        ({"consensus.graph": weighing(1.0, 0.5)}, "weigh differently each way"),
    ],
)
def test_what_it_is_not_of(changes, reason):
    scenario = load_scenario("quadrilateral", overrides=changes)
    with pytest.raises(IllPosedError, match=reason):
        require_consensus(resolve(scenario))
    with pytest.raises(IllPosedError, match=reason):
        linearize(scenario)


def test_a_robots_own_weights_are_its_own():
    formation = resolve(load_scenario("line", overrides={"tracking.R": {"1": 1.0, "2": 2.0}}))
    assert [local_lqr(formation, i).config.R for i in range(2)] == [1.0, 2.0]
    with pytest.raises(IllPosedError, match=r"robots have different tracking\.Q or R"):
        same_lqr(formation)
    assert same_lqr(resolve(load_scenario("line"))).config.R == 1.0
