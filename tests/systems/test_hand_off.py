import pytest
from pydrake.systems.analysis import Simulator

from drake_formation.systems.hand_off import HandOff


@pytest.fixture
def simulator():
    return Simulator(HandOff(1.5))


def phase(simulator):
    return simulator.get_system().GetOutputPort("phase").Eval(simulator.get_context()).item()


def test_the_phase_is_aggregation_until_the_hand_off(simulator):
    assert phase(simulator) == 0
    simulator.AdvanceTo(1.5)
    assert phase(simulator) == 0


def test_the_phase_is_transport_from_the_hand_off_on(simulator):
    simulator.AdvanceTo(1.5)
    simulator.AdvancePendingEvents()
    assert phase(simulator) == 1
    simulator.AdvanceTo(1e6)
    assert phase(simulator) == 1
