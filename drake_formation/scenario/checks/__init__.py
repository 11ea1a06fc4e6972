"""What must hold between several fields of a scenario, checked before Drake sees it."""

from drake_formation.scenario.checks import geometry, graphs, reference, simulator, tracking
from drake_formation.scenario.errors import Fault
from drake_formation.scenario.schema import Scenario


def check(scenario: Scenario) -> list[Fault]:
    """All faults that concern several fields at once; empty for a sound scenario.

    Args:
        scenario: its single fields are valid, as pydantic leaves them.
    """
    if faults := list(geometry.size(scenario)):
        return faults  # without a number of robots nothing else can be said
    places = list(geometry.check(scenario))
    return [
        *places,
        *([] if places else reference.check(scenario)),  # a curve needs sound places to begin and end at
        *graphs.check(scenario),
        *tracking.check(scenario),
        *simulator.check(scenario),
    ]
