"""What a scenario means, as plain arrays: computed once, and read by everything that comes after."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.links import Channels, Edges
from drake_formation.formation.obstacles import Obstacles
from drake_formation.formation.stages import Signals, Stage, signals

Array = NDArray[np.float64]

ROUNDING = 1e-9
"""Share of a number of periods that rounding may make of a whole number."""

SPRINGS = "springs"
"""The kind of object that has no block: springs between robots, which their plants carry out."""


@dataclass(frozen=True, eq=False)
class Formation:
    """A scenario resolved; :func:`drake_formation.scenario.resolve` makes it. Arrays cannot be written to.

    Robots are numbered from 0 here. Positions are in the world frame, slots relative to the formation centre.

    Attributes:
        name: of the scenario.
        slots: h_i (m), shape (N, 2).
        starts: where the robots start (m), shape (N, 2).
        centre: where the formation gathers, the mean of the starts (m), shape (2,).
        goal: where the formation centre is carried to (m), shape (2,).
        springs: which robots the object couples, E edges; none where it is a body of its own.
        channels: which robots hear which, C channels with weights.
        obstacles: M of them.
        footprints: radius of every robot about where it holds the object, 0 for a point (m), shape (N,).
        begin: when the scenario begins (s).
        aggregation_duration: how long the robots gather before the hand-off (s).
        transport_duration: how long they carry after it (s).
        law: the part by whose law the object's springs act.
        parts: the parts of every role: one a robot, one an edge for ``spring``, one a channel for ``channel``, and one
            in all for ``reference``, ``object`` and ``medium``.
        seed: of all that is random in it.
        tolerance: consensus error beyond which it counts as lost (m).
        stages: what failures of robots make of it, in order of time, the first from the beginning; none where no robot
            fails.
    """

    name: str
    slots: Array
    starts: Array
    centre: Array
    goal: Array
    springs: Edges
    channels: Channels
    obstacles: Obstacles
    footprints: Array
    begin: float
    aggregation_duration: float
    transport_duration: float
    law: type[Any]
    parts: Mapping[str, tuple[Any, ...]]
    seed: int = 0
    tolerance: float = 0.05
    stages: tuple[Stage, ...] = ()

    def __post_init__(self) -> None:
        for array in (self.slots, self.starts, self.centre, self.goal, self.footprints):
            array.setflags(write=False)

    @cached_property
    def kept(self) -> dict[str, Any]:
        """What others worked out from this formation and keep with it."""
        return {}

    @property
    def robots(self) -> int:
        """Number of robots N."""
        return len(self.slots)

    @property
    def hand_off(self) -> float:
        """When the object is placed on the robots (s)."""
        return self.begin + self.aggregation_duration

    @property
    def end(self) -> float:
        """When the scenario ends (s)."""
        return self.hand_off + self.transport_duration

    @cached_property
    def signals(self) -> Signals:
        """What blocks are told of the stages; see :func:`drake_formation.formation.stages.signals`."""
        return signals(self.stages, self.slots, self.springs, self.channels) if self.stages else {}

    @property
    def has_body(self) -> bool:
        """Whether the carried object is a body of its own, which exerts a load, and not springs between robots."""
        return bool(self.parts["object"][0].kind != SPRINGS)

    @property
    def has_medium(self) -> bool:
        """Whether channels compete for airtime, and each has not its own."""
        return bool(self.parts["medium"][0].kind != "none")

    @cached_property
    def radius(self) -> float:
        """Radius of the circle about the formation centre that holds every slot (m)."""
        return float(np.linalg.norm(self.slots, axis=1).max())

    @cached_property
    def extent(self) -> float:
        """Radius of the circle about the formation centre that holds every robot in its slot (m)."""
        return float((np.linalg.norm(self.slots, axis=1) + self.footprints).max())

    @cached_property
    def masses(self) -> Array:
        """Mass of every robot m_i (kg), shape (N,)."""
        return np.array([part.config.mass for part in self.parts["robot"]])

    @cached_property
    def start_velocities(self) -> Array:
        """Velocity at which every robot starts (m/s), shape (N, 2)."""
        return np.array([getattr(part.config, "velocity", (0.0, 0.0)) for part in self.parts["robot"]], dtype=float)

    def start_state(self, robot: int) -> Array:
        """Position and velocity with which a robot starts (m, m/s), shape (4,)."""
        return np.concatenate([self.starts[robot], self.start_velocities[robot]])

    @cached_property
    def sensing_ranges(self) -> Array:
        """At which every robot senses obstacles, from its footprint on (m), shape (N,); 0 where it senses none."""
        return np.array([getattr(part.config, "range", 0.0) for part in self.parts["avoidance"]], dtype=float)

    @cached_property
    def felt_within(self) -> float:
        """How far from obstacles the middle of a robot is at the most where it senses them (m); 0 where none does."""
        reach = float(self.sensing_ranges.max())
        return reach + float(self.footprints.max()) if reach else 0.0

    @cached_property
    def over_wires(self) -> bool:
        """Whether what is sent over any channel is received, at once and exactly."""
        return all(getattr(part, "is_wire", False) for part in self.parts["channel"])

    @cached_property
    def rest_lengths(self) -> Array:
        """r_ij of every edge of the object (m), shape (E,): ‖h_i − h_j‖ unless its spring has another one."""
        distances = self.springs.lengths(self.slots)
        parts = self.parts["spring"]
        return np.array([part.rest_length(d) for part, d in zip(parts, distances, strict=True)], dtype=float)

    @cached_property
    def elongations(self) -> Array:
        """r_ij/‖h_i − h_j‖ of every edge, 1 where its spring is at rest between the slots; shape (E,)."""
        distances = self.springs.lengths(self.slots)
        return np.where(
            self.rest_lengths == distances, 1.0, self.rest_lengths / np.where(distances > 0, distances, 1.0)
        )

    @property
    def at_rest_in_slots(self) -> bool:
        """Whether the object's springs are all at rest where the robots are in their slots."""
        return bool((self.elongations == 1.0).all())

    @cached_property
    def ticks(self) -> frozenset[tuple[float, float]]:
        """Period and offset (s) of the updates of all parts."""
        return frozenset(tick for parts in self.parts.values() for part in set(parts) for tick in part.ticks())

    def is_updated(self, times: Array) -> NDArray[np.bool_]:
        """Whether a part is updated at some times (s), of the same shape."""
        result = np.zeros(np.shape(times), dtype=bool)
        for period, offset in self.ticks:
            periods = (np.asarray(times) - offset) / period
            result |= (np.abs(periods - np.round(periods)) < ROUNDING * np.maximum(1.0, periods)) & (periods > -0.5)
        return result

    def displacements(self, robot: int, others: tuple[int, ...]) -> Array:
        """Desired displacement h_i − h_j of a robot from some others (m), shape (others, 2)."""
        result: Array = self.slots[robot] - self.slots[list(others)]
        return result

    def field(self, role: str, name: str) -> Array:
        """A number of the parts of a role, one for each, such as the stiffness (N/m) of every edge."""
        return np.array([getattr(part.config, name) for part in self.parts[role]], dtype=float)

    def faults_of_parts(self, roles: tuple[str, ...]) -> Iterator[tuple[str, int, Any]]:
        """What is wrong with the parts of some roles: role, owner and fault."""
        for role in roles:
            parts = self.parts[role]
            classes: set[Any] = set(map(type, parts))
            if not any(cls.has_checks() for cls in classes):
                continue
            for owner, part in enumerate(parts):
                for fault in part.checks(self, owner):
                    yield role, owner, fault

    def warnings_of_parts(self) -> Iterator[tuple[str, int, Any]]:
        """What may not be meant: role, owner and what it is."""
        for role, parts in self.parts.items():
            for owner, part in enumerate(parts):
                for fault in part.warnings(self, owner):
                    yield role, owner, fault

    def changed(self, **changes: Any) -> "Formation":
        """The formation with some attributes replaced."""
        return replace(self, **changes)
