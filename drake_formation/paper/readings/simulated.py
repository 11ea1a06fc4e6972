"""What the paper probably simulated: settings that explain more of its tables than what it prints.

What differs from the runs as printed: the obstacles push softly from afar; each is felt by one fixed robot; all cells
of a formation start from the same hand-off state; and virtual springs act along the lines between robots, as real ones
do (the form of Eq. 2), where there are more than two. The last is ad hoc: one law for all formations explains less.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.paper.runs import ACCURATE, MATERIALS, shipped
from drake_formation.scenario import Scenario, with_overrides
from drake_formation.simulation import simulate
from drake_formation.vectors import least_length


@dataclass(frozen=True, kw_only=True)
class Settings:
    """How a formation's transports were simulated.

    Attributes:
        duration: T_agg (s).
        gathering_gain: δ during aggregation (N/m); None for that of the transport.
        law: how virtual springs act during transport: ``linear`` on displacements, ``hookean`` along lines.
        assigned: with sensing ``assigned``, which robot feels each obstacle.
        sensing: who feels an obstacle.
        range: ρ0 (m).
        gain: η (N m²).
    """

    duration: float
    gathering_gain: float | None = 5.0
    law: str = "hookean"
    assigned: tuple[int, ...] = ()
    sensing: str = "assigned"
    range: float = 8.0
    gain: float = 4.2


BySettings = Mapping[str, Settings]
"""Settings of every formation, by its name."""

SIMULATED: BySettings = {
    "line": Settings(duration=60.0, assigned=(2, 1), law="linear"),
    "quadrilateral": Settings(duration=52.0, assigned=(4, 3)),
    "octagon": Settings(duration=71.0, assigned=(1, 5)),
}
"""As probably simulated. The robot that feels an obstacle is the one whose path in formation passes nearest, and of
equals the front one; but in the octagon the rear one for the first obstacle, chosen by the errors that this gives."""


def changed(settings: BySettings = SIMULATED, **changes: Any) -> dict[str, Settings]:
    """Settings with something else for all formations, or by formation where a mapping is given."""
    return {
        name: replace(
            its, **{key: value[name] if isinstance(value, Mapping) else value for key, value in changes.items()}
        )
        for name, its in settings.items()
    }


@cache
def handed_over(formation: str, settings: Settings, material: str, delta: float) -> Scenario:
    """A cell of Tables 2-6, from the hand-off on.

    Args:
        formation: shipped scenario.
        settings: how it was simulated.
        material: the object's.
        delta: consensus gain during transport (N/m).
    """
    return carried_on(shipped(formation), settings, material, delta)


def carried_on(scenario: Scenario, settings: Settings, material: str, delta: float) -> Scenario:
    """A scenario's transport from the hand-off on; see :func:`handed_over`."""
    gathering = delta if settings.gathering_gain is None else settings.gathering_gain
    overrides = {
        "springs.stiffness": MATERIALS[material],
        "consensus.delta": delta,
        "consensus.law": settings.law,
        "avoidance.range": settings.range,
        "avoidance.gain": settings.gain,
        "avoidance.sensing": settings.sensing,
        "avoidance.assigned": list(settings.assigned) if settings.sensing == "assigned" else [],
    }
    begun = hand_off(scenario, gathering, settings.duration)
    return with_overrides(scenario, ACCURATE | overrides | begun)


@cache
def hand_off(scenario: Scenario, delta: float, duration: float) -> dict[str, Any]:
    """The state at the end of an aggregation, as overrides by which a scenario begins there.

    Args:
        scenario: what the robots gather for.
        delta: consensus gain while the robots gather (N/m).
        duration: T_agg (s).
    """
    gathering = {"consensus.delta": delta, "aggregation.duration": duration, "transport.duration": 0.01}
    result = simulate(with_overrides(scenario, ACCURATE | gathering), engine="compiled")
    state = result.isel(time=int(np.argmax(result["phase"].values == 1)))
    velocities = {str(robot): state["velocity"].sel(robot=robot).values.tolist() for robot in state["robot"].values}
    return {
        "aggregation.duration": 0.0,
        "robots.start": state["position"].values.tolist(),
        "robots.velocity": velocities,
    }


def passes(formation: Formation) -> NDArray[np.float64]:
    """How near each robot's slot comes to each obstacle on the straight way to the goal (m), shape (N, obstacles)."""
    begin = (formation.centre + formation.slots)[:, None] - formation.obstacles.middles
    return least_length(begin, np.broadcast_to(formation.goal - formation.centre, begin.shape))
