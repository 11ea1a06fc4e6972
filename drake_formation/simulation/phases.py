"""What a scenario has run: aggregation, transport, and the transport once more where obstacles are felt."""

from collections.abc import Callable

from drake_formation.formation.formation import Formation
from drake_formation.scenario import Scenario, resolve

Progress = Callable[[float], None]
"""Called with how much simulated time is done, from 0 to :func:`simulated_duration` (s)."""

FAR_AWAY = 1e9
"""Where no robot senses an obstacle (m)."""


def simulated_duration(scenario: Scenario) -> float:
    """How much time :func:`simulate` simulates in all (s)."""
    formation = resolve(scenario)
    repeats = 2 if felt_obstacles(formation) else 1
    return formation.aggregation_duration + repeats * formation.transport_duration


def felt_obstacles(formation: Formation) -> bool:
    """Whether any obstacle may change a force: by avoidance, or by coordination that keeps a clearance."""
    pushed = any(getattr(part.config, "gain", 1.0) > 0 for part in formation.parts["avoidance"])
    kept = any(getattr(part.config, "clearance", None) is not None for part in formation.parts["coordination"])
    return bool(len(formation.obstacles)) and (pushed or kept)


def without_obstacles(formation: Formation) -> Formation:
    """The formation with all obstacles out of reach; its structure is the same."""
    return formation.changed(obstacles=formation.obstacles.shifted([FAR_AWAY, FAR_AWAY]))
