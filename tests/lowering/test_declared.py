"""Which events a block has is found out, whoever declares them."""

import pytest
from pydrake.systems.framework import LeafSystem
from pydrake.systems.primitives import DiscreteTimeDelay, Gain, LinearSystem, Sine, ZeroOrderHold

from drake_formation.lowering import LoweringError
from drake_formation.lowering.declared import is_pythons, recorded, require_known_events
from tests.lowering.random_diagrams import INERT, REFUSED, Pushed, Sampled


def conversion(block):
    with recorded() as names:
        return block.ToSymbolic(), names


def test_what_a_helper_declares_is_seen():
    _, names = conversion(Sampled(1, 0.5, 0.25, INERT["forced"]))
    assert names == ["DeclarePeriodicDiscreteUpdateEvent", "DeclareForcedDiscreteUpdateEvent"]
    assert conversion(Pushed(2))[1] == []


def test_nothing_is_left_of_the_stand_in():
    before = vars(LeafSystem).keys()
    conversion(Sampled(1, 0.5, 0.25))
    assert vars(LeafSystem).keys() == before
    with recorded() as names:
        pass
    Sampled(1, 0.5, 0.25).ToSymbolic()
    assert names == []


@pytest.mark.parametrize("declare", REFUSED.values(), ids=REFUSED)
def test_what_would_be_left_out_is_refused(declare):
    block = Sampled(1, 0.5, 0.25, declare)
    with pytest.raises(LoweringError, match="'here'"):
        require_known_events("here", block, conversion(block)[1])


@pytest.mark.parametrize("declare", REFUSED.values(), ids=REFUSED)
def test_what_is_declared_on_a_block_later_is_found_by_running_it(declare):
    block = Sampled(1, 0.5, 0.25)
    declare(block)
    with pytest.raises(LoweringError, match="'here'"):
        require_known_events("here", block, conversion(block)[1])


@pytest.mark.parametrize("period", [1e-3, 0.5, 3.0, 1e4])
def test_what_is_published_now_and_then_is_found(period):
    block = Pushed(1)
    block.DeclarePeriodicPublishEvent(period, 0.7 * period, lambda context: None)
    with pytest.raises(LoweringError, match="event of its own time"):
        require_known_events("here", block, [])


@pytest.mark.parametrize("declare", [None, *INERT.values()])
def test_what_is_carried_out_or_never_happens_is_not(declare):
    block = Sampled(1, 0.5, 0.25, declare)
    require_known_events("here", block, conversion(block)[1])


@pytest.mark.parametrize(
    "block",
    [
        Gain(1.0, 2),
        Sine(1.0, 1.0, 0.0, 1),
        ZeroOrderHold(0.1, 1, 0.03),
        DiscreteTimeDelay(0.1, 3, 2),
        LinearSystem([[0.5]], [[1.0]], [[1.0]], [[0.0]], 0.1),
    ],
    ids=lambda block: type(block).__name__,
)
def test_drakes_own_blocks_are_quiet_between_their_ticks(block):
    assert not is_pythons(block)
    require_known_events("here", block, [])


def test_pythons_blocks_are_told_from_drakes():
    assert is_pythons(Pushed(1))
    assert is_pythons(LeafSystem()) is False
