"""A deformable object: a plate of point masses and springs over the formation, so that rubber has mass and waves."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.errors import Fault
from drake_formation.config.values import NonNegative, Positive
from drake_formation.formation.formation import Formation
from drake_formation.parts.objects.carried import CarriedObject
from drake_formation.parts.objects.grips import GripNumbers
from drake_formation.parts.objects.plate import PlateMechanics
from drake_formation.parts.part import Array, Numbers
from drake_formation.parts.registry import part

Indices = NDArray[np.int64]

MOST = 30
"""Nodes in a row or column; the code of a plate of more would be too long to compile."""

FLAT = 1e-9
"""A side of the plate shorter than this share of the other is none."""


@part("object", kind="lattice")
class Lattice(CarriedObject):
    """A deformable plate of point masses and springs, on a grid over the bounding box of the slots."""

    class Config(GripNumbers):
        """The plate, and its grips; the more nodes, the longer it compiles: 8 by 8 take some ten seconds, once."""

        mass: Positive = Field(default=20.0, description="mass m (kg), shared by all nodes alike; chosen: 20")
        rows: int = Field(
            default=4, ge=1, le=MOST, description="nodes along y, one where the slots are in a row along x"
        )
        columns: int = Field(
            default=4, ge=1, le=MOST, description="nodes along x, one where the slots are in a row along y"
        )
        stiffness: Positive = Field(
            default=1e3, description="stiffness k (N/m) of each spring along rows and columns; chosen: 1000"
        )
        shear_stiffness: NonNegative = Field(
            default=500.0, description="stiffness k_s (N/m) of each spring along the diagonals of a cell; chosen: 500"
        )
        damping: NonNegative = Field(
            default=5.0,
            description="damping c (N s/m) of each spring along rows and columns; that of the diagonals is to it as "
            "their stiffness; chosen: 5",
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether the grid has room, and reaches all slots."""
        sides, config = extent(formation), self.config
        for key, axis, count, side in zip(("columns", "rows"), "xy", (config.columns, config.rows), sides, strict=True):
            flat = side <= FLAT * max(sides)
            if flat and count > 1:
                yield Fault((key,), f"the slots have no extent along {axis}", str(count), "1")
            if not flat and count == 1:
                message = f"one node does not reach over the {side:.4g} m of the slots along {axis}"
                yield Fault((key,), message, str(count), f"2 to {MOST}")
        if config.rows == config.columns == 1:
            yield Fault((), "one node is no plate", allowed="more nodes, or kind rigid")

    def mechanics(self, formation: Formation) -> PlateMechanics:
        """Of a plate, each robot in its cell."""
        corners, _ = cells(formation.slots, self.config.rows, self.config.columns)
        return PlateMechanics(self.config.rows, self.config.columns, tuple(map(tuple, corners.tolist())))

    def own_numbers(self, formation: Formation) -> Numbers:
        """Node, springs and cell, and where in its cell each robot holds."""
        config = self.config
        shear = config.shear_stiffness, config.damping * config.shear_stiffness / config.stiffness
        width, height = extent(formation) / np.maximum([config.columns - 1, config.rows - 1], 1)
        plate = np.array([self.node_mass, config.stiffness, config.damping, *shear, width, height])
        _, weights = cells(formation.slots, config.rows, config.columns)
        return plate, weights.ravel()

    def initial_state(self, formation: Formation, owner: int) -> Array:  # noqa: ARG002
        """At rest, its nodes on the grid over the slots where the formation gathers."""
        low, high = formation.slots.min(axis=0), formation.slots.max(axis=0)
        x, y = np.linspace(low[0], high[0], self.config.columns), np.linspace(low[1], high[1], self.config.rows)
        nodes = np.stack(np.meshgrid(x, y), axis=-1) + formation.centre
        return np.concatenate([nodes.ravel(), np.zeros(nodes.size)])

    @property
    def node_mass(self) -> float:
        """Of each node (kg)."""
        mass: float = self.config.mass / (self.config.rows * self.config.columns)
        return mass

    def fastest(self, formation: Formation) -> tuple[float, float]:
        """Of neighbouring nodes against each other, and of a grip between a robot and a node."""
        config = self.config
        springs = 8 * (config.stiffness + config.shear_stiffness) / self.node_mass
        lightness = 1.0 / self.node_mass + 1.0 / formation.masses.min()
        damping = springs * config.damping / config.stiffness + config.grip_damping * lightness
        return springs + config.grip_stiffness * lightness, damping


def extent(formation: Formation) -> Array:
    """Sides of the bounding box of the slots (m), along x and y."""
    sides: Array = np.ptp(formation.slots, axis=0)
    return sides


def cells(slots: Array, rows: int, columns: int) -> tuple[Indices, Array]:
    """Which cell of the grid over their bounding box each slot is in, and where in it.

    Args:
        slots: h (m), shape (N, 2).
        rows: of nodes, along y.
        columns: of nodes, along x.

    Returns:
        The cell's nodes by index row by row, shape (N, 4): lower left, lower right, upper left, upper right; and their
        bilinear weights, of the same shape.
    """
    steps = np.array([columns - 1, rows - 1])
    low, sides = slots.min(axis=0), np.ptp(slots, axis=0)
    along = (slots - low) / np.where(steps > 0, sides, 1.0) * steps  # in cells
    first = np.clip(np.floor(along + FLAT).astype(np.int64), 0, np.maximum(steps - 1, 0))
    share = along - first
    column, row = np.stack([first, np.minimum(first + 1, steps)], axis=1).T.swapaxes(1, 2)
    across, up = np.stack([1.0 - share, share], axis=1).T.swapaxes(1, 2)
    corners = row[:, :, None] * columns + column[:, None, :]
    weights = up[:, :, None] * across[:, None, :]
    return corners.reshape(-1, 4), weights.reshape(-1, 4)
