"""What a scenario has run: aggregation, transport, and the transport once more where obstacles are felt."""

from collections.abc import Callable

from drake_formation.scenario import Scenario

Progress = Callable[[float], None]
"""Called with how much simulated time is done, from 0 to :func:`simulated_duration` (s)."""


def simulated_duration(scenario: Scenario) -> float:
    """How much time :func:`simulate` simulates in all (s)."""
    repeats = 2 if felt_obstacles(scenario) else 1
    return scenario.aggregation.duration + repeats * scenario.transport.duration


def felt_obstacles(scenario: Scenario) -> bool:
    """Whether any obstacle exerts a force."""
    return bool(scenario.avoidance.obstacles) and scenario.avoidance.gain > 0


def without_obstacles(scenario: Scenario) -> Scenario:
    """The scenario in which no obstacle exerts a force; its structure is the same."""
    return scenario.model_copy(update={"avoidance": scenario.avoidance.model_copy(update={"gain": 0.0})})
