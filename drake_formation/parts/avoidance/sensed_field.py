"""What force fields around obstacles have in common: their range and strength, and which robot feels which obstacle."""

from collections.abc import Hashable, Iterator
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import Length, NonNegative, Section
from drake_formation.formation.formation import Formation
from drake_formation.formation.obstacles import Obstacles
from drake_formation.parts.part import Numbers, Part

Robots = Annotated[tuple[int, ...], Field(strict=False)]
"""Numbers of robots, from 1."""


class FieldStrength(Section):
    """Range and strength of a field."""

    range: Length = Field(default=1.3, description="sensing range ρ0 (m); inferred: 1.3")
    gain: NonNegative = Field(default=31.56, description="repulsive gain η (N m²); inferred: 31.56")


class FieldConfig(FieldStrength):
    """Range and strength of a field, and who feels it."""

    sensing: Literal["in_range", "nearest", "assigned"] = Field(
        default="in_range",
        description="in_range: every robot within range feels an obstacle; nearest: only the one nearest to it, "
        "with margin 0 not with the engine exponential, and robots that stay equally near feel it in turns, in very "
        "short steps; "
        "assigned: only the one that assigned names",
    )
    margin: NonNegative = Field(
        default=0.0,
        description="margin (m) by which, with sensing nearest, another robot must be nearer to an obstacle to feel it "
        "instead, compared every 0.05 s; 0 hands it over at once, at any time",
    )
    assigned: Robots = Field(
        default=(), description="with sensing assigned, for each obstacle the number of the robot that feels it"
    )
    robots: bool = Field(
        default=False,
        description="keep away, in both phases, from the robots heard, as from points or their footprints, within the "
        "spacing",
    )
    spacing: Length = Field(
        default=0.5,
        description="range ρ_r (m) of the field around other robots, below the slots' distances less the footprints",
    )
    line_of_sight: bool = Field(
        default=False,
        description="feel an obstacle only where no other robot's footprint and no other obstacle stands between, "
        "looked at every 0.05 s",
    )


class SensedField(Part):
    """A field around obstacles that some robots sense; its configuration is a :class:`FieldConfig`."""

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether assignments, margin and spacing suit the formation."""
        if self.config.sensing == "assigned":
            yield from self._assignment_faults(formation)
            if self.config.line_of_sight:
                message = "who feels an obstacle is assigned, whether it is seen or not"
                yield Fault(("line_of_sight",), message, "true", "false, or another avoidance.sensing")
        margins = {part.margin for part in formation.parts["avoidance"] if getattr(part, "masked", False)}
        if self.masked and len(margins) > 1:
            values = shown(sorted(margins))
            yield Fault(("margin",), "robots that compare distances have different margins", values, "one for all")

        for other in self.neighbours(formation, owner):
            between = float(np.linalg.norm(formation.slots[owner] - formation.slots[other - 1]))
            apart = between - float(formation.footprints[owner] + formation.footprints[other - 1])
            if apart <= self.config.spacing and formation.slots.any():
                message = f"robots {owner + 1} and {other} would be pushed out of their slots, {apart:.4g} m apart"
                yield Fault(("spacing",), message, shown(self.config.spacing), f"below {apart:.4g} m")

    def _assignment_faults(self, formation: Formation) -> Iterator[Fault]:
        assigned, count = self.config.assigned, len(formation.obstacles)
        allowed = f"{count} numbers of robots from 1 to {formation.robots}, one an obstacle"
        if len(assigned) != count:
            yield Fault(("assigned",), f"{len(assigned)} robots for {count} obstacles", shown(assigned), allowed)
        for index, robot in enumerate(assigned):
            if not 1 <= robot <= formation.robots:
                yield Fault(("assigned", index), f"there is no robot {robot}", shown(robot), allowed)

    def structure(self) -> Hashable:
        """Who feels an obstacle, whether that depends on the past, and whether robots are kept apart."""
        return self.config.sensing, self.margin > 0, self.config.robots, self.config.line_of_sight

    @property
    def masked(self) -> bool:
        """Whether it depends on where the others are, and so on the input port ``sensed``, what the robot feels."""
        return bool(self.config.sensing == "nearest")

    @property
    def margin(self) -> float:
        """How much nearer another robot must be to take over (m); 0 where that plays no part."""
        return float(self.config.margin) if self.masked else 0.0

    def feels(self, formation: Formation, owner: int) -> NDArray[np.bool_]:
        """Which obstacles the robot feels as far as they are sensed, shape (obstacles,)."""
        if self.config.sensing != "assigned":
            return np.ones(len(formation.obstacles), dtype=bool)
        feels: NDArray[np.bool_] = np.array(self.config.assigned, dtype=int) == owner + 1
        return feels

    def felt(self, formation: Formation, owner: int) -> Obstacles:
        """Those obstacles."""
        return formation.obstacles.chosen(self.feels(formation, owner))

    def layout(self, formation: Formation, owner: int) -> Hashable:
        """The shapes of those obstacles, and whether they move."""
        return self.felt(formation, owner).layout

    def neighbours(self, formation: Formation, owner: int) -> list[int]:
        """Numbers, from 1, of the robots that it keeps away from: those it hears."""
        return [j + 1 for j in formation.channels.heard[owner]] if self.config.robots else []

    def of_robots(self, formation: Formation, owner: int) -> Numbers:
        """The range of the field around robots (m), where they are kept apart; and the footprints, if there are any.

        Those are the radius of its own and of the robots that it keeps away from (m).
        """
        spacing = (np.array([self.config.spacing]),) if self.config.robots else ()
        if not formation.footprints.any():
            return spacing
        others = [j - 1 for j in self.neighbours(formation, owner)]
        return *spacing, formation.footprints[[owner, *others]]
