"""A plan around known obstacles as reference, by an artificial potential field before the run."""

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydrake.trajectories import PiecewisePolynomial

from drake_formation.config.errors import Fault, Path, shown
from drake_formation.config.values import Gap, Known
from drake_formation.formation.formation import Formation
from drake_formation.parts.references.planner import (
    PotentialField,
    StuckError,
    clearances,
    closest,
    plan,
    plan_trajectory,
)
from drake_formation.parts.references.trajectory import Motion, MotionConfig
from drake_formation.parts.references.waypoints import NEAREST
from drake_formation.parts.registry import part

Array = NDArray[np.float64]

KEPT = 0.75
"""What a smoothed plan keeps of the clearance, at least."""


@part("reference", kind="potential_field")
class PlannedReference(Motion):
    """A way around known obstacles, planned by an artificial potential field before the run."""

    class Config(MotionConfig):
        """What the plan knows, and how far it keeps away."""

        known: Known = Field(
            default="all",
            description="which obstacles the plan knows, numbered from 1, or all that are known; robots sense all",
        )
        clearance: Gap = Field(
            default=1.3,
            description="what the plan keeps between formation and known obstacles (m), at least three quarters of it "
            "where smoothing cuts corners; chosen: 1.3, the sensing range, so that who follows the plan feels none",
        )
        reach: Gap = Field(
            default=2.6, description="clearance below which the plan gives way (m), more than clearance; chosen: 2.6"
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether it is in time, and gets past what it knows."""
        late = list(self.duration_faults(formation))
        yield from late
        faults = [*self._known_faults(formation), *self._reach_faults()] or list(self._place_faults(formation))
        yield from faults
        if not faults and not late:
            yield from self._plan_faults(formation)

    def known(self, formation: Formation) -> list[int]:
        """Indices, from 0, of the obstacles that the plan knows."""
        if self.config.known == "all":
            return [index for index, obstacle in enumerate(formation.obstacles) if obstacle.known]
        return [number - 1 for number in self.config.known]

    def field(self, formation: Formation) -> PotentialField:
        """The field in which the formation centre is planned."""
        known = formation.obstacles.chosen(self.known(formation)).grown(formation.extent)
        return PotentialField(formation.goal, known, self.config.clearance, self.config.reach)

    def trajectory(self, formation: Formation) -> PiecewisePolynomial:
        """The plan, made once for a formation.

        Raises:
            StuckError: it does not reach the goal.
        """
        if formation not in self._plans:
            field = self.field(formation)
            path = plan(formation.centre, field)
            self._plans.clear()
            self._plans[formation] = plan_trajectory(path, field, self.duration(formation))
        return self._plans[formation]

    @cached_property
    def _plans(self) -> dict[Formation, Any]:
        return {}

    def _known_faults(self, formation: Formation) -> Iterator[Fault]:
        """Obstacles one by one: such as there are, and each once."""
        count = len(formation.obstacles)
        numbers = () if self.config.known == "all" else self.config.known
        allowed = f"numbers of obstacles from 1 to {count}" if count else "none, there are no obstacles"
        for index, number in enumerate(numbers):
            path = ("known", index)
            if not 1 <= number <= count:
                yield Fault(path, f"there is no obstacle {number}", shown(number), allowed)
            elif number in numbers[:index]:
                yield Fault(path, f"the same obstacle as entry {numbers.index(number)}", shown(number), "each once")
            elif not formation.obstacles.items[number - 1].known:
                message = f"obstacle {number} is said to be unknown"
                yield Fault(path, message, shown(number), f"avoidance.obstacles.{number - 1}.known: true")
        for index in self.known(formation):
            if 0 <= index < count and len(formation.obstacles.items[index].motion):
                message = f"obstacle {index + 1} moves, and a plan made before the run knows obstacles at rest alone"
                allowed = f"avoidance.obstacles.{index}.known: false, or an obstacle at rest"
                yield Fault(("known",), message, shown(self.config.known), allowed)

    def _reach_faults(self) -> Iterator[Fault]:
        if self.config.reach <= self.config.clearance:
            allowed = f"more than transport.reference.clearance, {self.config.clearance:g} m"
            yield Fault(("reach",), "not beyond the clearance", shown(self.config.reach), allowed)

    def _place_faults(self, formation: Formation) -> Iterator[Fault]:
        """Start and goal of a plan: apart, and clear of what it knows."""
        start, goal = formation.centre, formation.goal
        if np.linalg.norm(goal - start) <= NEAREST:
            message, allowed = "where the formation gathers already: nothing to plan", "another goal, or kind set_point"
            yield Fault(GOAL, message, shown(goal.tolist()), allowed)
        field, known, clearance = self.field(formation), self.known(formation), self.config.clearance
        places: tuple[tuple[Path, str, Array], ...] = (
            (STARTS, "the formation gathers", start),
            (GOAL, "the formation at the goal is", goal),
        )
        for path, what, centre in places:
            for index in np.flatnonzero(clearances(centre, field.obstacles) <= clearance):
                apart = clearance + field.obstacles.radii[index]
                message = f"{what} nearer to obstacle {known[index] + 1} than the plan's clearance"
                allowed = (
                    f"a formation centre more than {apart:.4g} m from it, or a smaller transport.reference.clearance"
                )
                yield Fault(path, message, shown(centre.tolist()), allowed)

    def _plan_faults(self, formation: Formation) -> Iterator[Fault]:
        ways_out = "a smaller clearance, fewer known obstacles, or points of your own (kind waypoints)"
        try:
            trajectory = self.trajectory(formation)
        except StuckError as error:
            place = shown([round(x, 3) for x in error.place.tolist()])
            message = f"the plan gets stuck between known obstacles at {place}, in a local minimum of the field"
            yield Fault((), message, allowed=ways_out)
            return
        places = trajectory.vector_values(np.linspace(0.0, trajectory.end_time(), 1000)).T
        kept = closest(places, self.field(formation).obstacles).min(initial=np.inf)
        if kept < KEPT * self.config.clearance:
            message = f"the plan comes within {kept:.3g} m of a known obstacle when smoothed"
            yield Fault(("clearance",), message, shown(self.config.clearance), ways_out)


GOAL: Path = ("..", "goal")
STARTS: Path = ("..", "..", "robots", "start")
"""Paths from a reference's own section."""
