"""What all robots in the plane have in common: a mass, a velocity at the start, and springs to their neighbours."""

from typing import Any, ClassVar

import numpy as np
from pydantic import Field

from drake_formation.config.values import Positive, Section, Velocity
from drake_formation.formation.formation import Formation
from drake_formation.parts.objects.breaking import breaks
from drake_formation.parts.part import Array, Numbers, Part
from drake_formation.parts.robots.plant import Dynamics, PlanarRobot


class RobotNumbers(Section):
    """Mass and velocity at the start."""

    mass: Positive = Field(default=40.0, description="mass m_i (kg), one for all or one a robot; published: 40")
    velocity: Velocity = Field(
        default=(0.0, 0.0),
        description="starting velocity (m/s) of where it holds the object, for all or a mapping; published: at rest",
    )


class Robot(Part):
    """A robot in the plane; its kinds say by what dynamics it moves.

    Attributes:
        dynamics: see :data:`drake_formation.parts.robots.plant.Dynamics`.
        may_fail: whether its drives may fail and its brakes lock: all that moves it is the control force then.
        has_heading: whether its first inner state is a heading (rad).
    """

    Config = RobotNumbers
    dynamics: ClassVar[Dynamics]
    may_fail: ClassVar[bool] = False
    has_heading: ClassVar[bool] = False

    def own_numbers(self) -> Numbers:
        """What its dynamics compute with, by group."""
        return (np.array([self.config.mass]),)

    def inner_state(self) -> Array:
        """The inner states of its dynamics at the start; none by default."""
        return np.zeros(0)

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """Its own, and of each spring the law's numbers and the desired displacement."""
        return *self.own_numbers(), spring_table(formation, owner)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The plant."""
        *own, springs = numbers
        start, neighbours = self.initial_state(formation, owner), held_robots(formation, owner)
        ports = {"heading": self.has_heading, **options(formation, owner)}
        return PlanarRobot(self.dynamics, neighbours, formation.law, own, springs, start, **ports)

    def initial_state(self, formation: Formation, owner: int) -> Array:
        """At its starting position, with its starting velocity."""
        return np.concatenate([formation.starts[owner], self.config.velocity, self.inner_state()])


def options(formation: Formation, robot: int) -> dict[str, Any]:
    """What a robot's plant has ports for beyond those that all have."""
    springs_break = breaks(formation) and not formation.has_body and formation.springs.neighbours[robot]
    releases = ["intact"] if springs_break else []
    if not formation.has_body and f"held_{robot + 1}" in formation.signals:
        releases.append("held")
    return {
        "load": formation.has_body,
        "releases": tuple(releases),
        "may_fail": f"failure_{robot + 1}" in formation.signals,
    }


def held_robots(formation: Formation, robot: int) -> list[int]:
    """Numbers of the robots that the object couples a robot to, from 1."""
    return [j + 1 for j in formation.springs.neighbours[robot]]


def spring_table(formation: Formation, robot: int) -> Array:
    """Of each spring of a robot in port order, the numbers of the law and where it is at rest, (neighbours, columns).

    That is h_i − h_j (m), as long as the spring is at rest.
    """
    others, edges = formation.springs.neighbours[robot], formation.springs.incident(robot)
    rows = [formation.parts["spring"][edge].numbers(formation, edge)[0] for edge in edges]
    numbers = np.array(rows, dtype=float).reshape(len(others), len(formation.law.arguments()))
    return np.column_stack([numbers, formation.displacements(robot, others) * formation.elongations[edges, None]])
