"""What robots look like, by their kind; each stands at the point where it holds the object, its heading along x."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from pydrake.geometry import Box, Cylinder, Sphere
from pydrake.math import RigidTransform, RotationMatrix

from drake_formation.formation.formation import Formation
from drake_formation.viz.view.solids import CARRYING_HEIGHT, DARK, TALKING_HEIGHT, Solid

RADIUS = 0.18
"""Of a robot that tells no size (m), unless the slots are closer than that allows."""

ACROSS = RotationMatrix.MakeXRotation(np.pi / 2)
"""Turns the axis of a cylinder across the heading."""


def solids_of(formation: Formation, robot: int) -> Iterator[Solid]:
    """What a robot, from 0, looks like: its body, and the antenna over which it talks."""
    part = formation.parts["robot"][robot]
    radius = float(formation.footprints[robot]) or min(RADIUS, _room(formation))
    yield from BODIES.get(part.kind, disk)(part.config, radius)
    mast = TALKING_HEIGHT - CARRYING_HEIGHT
    yield Solid(Cylinder(0.012, mast), RigidTransform([0, 0, CARRYING_HEIGHT + mast / 2]), DARK)
    yield Solid(Sphere(0.03), RigidTransform([0, 0, TALKING_HEIGHT]))


def disk(_config: Any, radius: float) -> Iterator[Solid]:
    """A point mass, or a robot of a kind that is not known here: round, for it has no heading."""
    yield Solid(Cylinder(radius, CARRYING_HEIGHT), RigidTransform([0, 0, CARRYING_HEIGHT / 2]))


def omnidirectional(config: Any, _radius: float) -> Iterator[Solid]:
    """A body on omni or mecanum wheels where they stand, each across the direction in which it pushes; a white nose."""
    reach = config.wheel_distance
    wheel = min(0.07, 0.4 * reach)
    push = config.push_angles or [angle + 90.0 for angle in config.wheel_angles]
    yield Solid(Cylinder(0.75 * reach, CARRYING_HEIGHT - wheel), _at(0, 0, wheel + (CARRYING_HEIGHT - wheel) / 2))
    yield Solid(Box(0.5 * reach, 0.12 * reach, 0.02), _at(0.5 * reach, 0, CARRYING_HEIGHT + 0.01), (1, 1, 1, 1))
    for mounting, rolling in zip(np.radians(config.wheel_angles), np.radians(push), strict=True):
        turned = RotationMatrix.MakeZRotation(rolling) @ ACROSS
        place = [reach * np.cos(mounting), reach * np.sin(mounting), wheel]
        yield Solid(Cylinder(wheel, 0.04), RigidTransform(turned, place), DARK)


def unicycle(config: Any, _radius: float) -> Iterator[Solid]:
    """A body between two wheels, behind the point where it holds the object at the end of an arm."""
    ahead, track = config.ahead, config.track
    wheel = min(0.12, 0.3 * track)
    long = min(0.8 * track, 1.6 * ahead)
    yield Solid(Box(long, 0.8 * track, CARRYING_HEIGHT - wheel / 2), _at(-ahead, 0, wheel / 4 + CARRYING_HEIGHT / 2))
    yield Solid(Box(ahead, 0.05, 0.03), _at(-ahead / 2, 0, CARRYING_HEIGHT), DARK)
    yield Solid(Cylinder(0.05, 0.06), _at(0, 0, CARRYING_HEIGHT))
    for side in (-0.5, 0.5):
        yield Solid(Cylinder(wheel, 0.05), RigidTransform(ACROSS, [-ahead, side * track, wheel]), DARK)


BODIES: dict[str, Callable[[Any, float], Iterator[Solid]]] = {
    "point_mass": disk,
    "omnidirectional": omnidirectional,
    "unicycle": unicycle,
}
"""By kind: of a robot's configuration and the radius of one whose kind tells no size (m)."""


def _room(formation: Formation) -> float:
    """The radius that robots in neighbouring slots may have without touching (m)."""
    if formation.robots == 1:
        return RADIUS
    apart = np.linalg.norm(formation.slots[:, None] - formation.slots, axis=-1)
    return 0.4 * float(apart[~np.eye(formation.robots, dtype=bool)].min())


def _at(x: float, y: float, z: float) -> RigidTransform:
    return RigidTransform([x, y, z])
