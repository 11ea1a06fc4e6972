"""Numbers of a scenario that sliders in the browser change: δ, δ_v and k."""

import math
from dataclasses import dataclass
from typing import Any

from drake_formation.scenario import Scenario, with_overrides


@dataclass(frozen=True)
class Knob:
    """A slider for one number of a scenario, the same for all robots or edges.

    Attributes:
        label: in the browser.
        path: of the number in a scenario.
        low, high: what the slider reaches.
        step: of the slider.
        logarithmic: whether the slider shows the power of ten.
    """

    label: str
    path: str
    low: float
    high: float
    step: float
    logarithmic: bool = False

    def shown(self, scenario: Scenario) -> float | None:
        """Where the slider stands for a scenario; None where that has no such number, or several."""
        value: Any = scenario
        for key in self.path.split("."):
            value = getattr(value, key, None)
        if not isinstance(value, int | float):
            return None
        place = math.log10(value) if self.logarithmic else value
        return min(max(place, self.low), self.high)

    def value(self, place: float) -> float:
        """The number for which a place of the slider stands."""
        return float(f"{10.0**place:.4g}") if self.logarithmic else place


KNOBS = (
    Knob("δ (N/m)", "consensus.delta", 0.0, 2e4, 1.0),
    Knob("δ_v (N s/m)", "consensus.delta_v", 0.0, 2e3, 0.1),
    Knob("log10 of k (N/m)", "springs.stiffness", -1.0, 5.0, 0.01, logarithmic=True),
)
"""Over the values of the paper, and those that damp them."""


def changed(scenario: Scenario, places: dict[Knob, float], before: dict[Knob, float]) -> Scenario:
    """A scenario with the numbers of the sliders that were moved; the others stay as they are written.

    Args:
        scenario: left as it is.
        places: where the sliders stand.
        before: where they stood for the scenario.

    Raises:
        ScenarioError: the numbers do not go together.
    """
    moved = {knob.path: knob.value(place) for knob, place in places.items() if place != before[knob]}
    return with_overrides(scenario, moved) if moved else scenario
