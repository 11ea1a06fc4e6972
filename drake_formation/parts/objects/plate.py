"""A deformable plate: point masses on a grid, with springs between them, held in its cells.

Rows go along x, and arrays of the grid have the shape (rows, columns, 2): x and y, in the world frame.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from drake_formation.parts.objects.carried import Mechanics
from drake_formation.parts.objects.grips import Motion, Pair
from drake_formation.systems.scalars import Scalar, atan2, largest

quiet = np.errstate(invalid="ignore", divide="ignore")
"""NumPy warns of arrays of Expression for nothing, and what is not finite the engines tell of."""

ALL, BUT_LAST, BUT_FIRST = slice(None), slice(-1), slice(1, None)
Nodes = tuple[slice, slice]


class Springs(NamedTuple):
    """Springs of the grid that are alike.

    Attributes:
        begin: the nodes, by row and column, at which they begin.
        end: those at which they end.
        length: at rest (m).
        stiffness: of each (N/m).
        damping: of each (N s/m).
    """

    begin: Nodes
    end: Nodes
    length: Scalar
    stiffness: Scalar
    damping: Scalar


def springs_of(plate: Sequence[Scalar]) -> Iterator[Springs]:
    """Springs along rows, along columns, and along both diagonals of every cell.

    Args:
        plate: m of a node (kg), k and c of the springs along rows and columns (N/m, N s/m), those of the diagonals,
            and the width and height of a cell (m).
    """
    _, k, c, diagonal_k, diagonal_c, width, height = plate
    across = (width * width + height * height) ** 0.5
    yield Springs((ALL, BUT_LAST), (ALL, BUT_FIRST), width, k, c)
    yield Springs((BUT_LAST, ALL), (BUT_FIRST, ALL), height, k, c)
    yield Springs((BUT_LAST, BUT_LAST), (BUT_FIRST, BUT_FIRST), across, diagonal_k, diagonal_c)
    yield Springs((BUT_LAST, BUT_FIRST), (BUT_FIRST, BUT_LAST), across, diagonal_k, diagonal_c)


def spring_forces(positions: Any, velocities: Any, plate: Sequence[Scalar]) -> Any:
    """What the springs exert on the nodes, each along the line between its ends: (k (1 − r/d) + c ḋ/d) (q_j − q_i).

    Args:
        positions: of the nodes (m), shape (rows, columns, 2).
        velocities: of the nodes (m/s), likewise.
        plate: as for :func:`springs_of`.

    Returns:
        Forces (N), shape (rows, columns, 2).
    """
    forces = 0.0 * positions
    for springs in springs_of(plate):
        way = positions[springs.end] - positions[springs.begin]
        approach = velocities[springs.end] - velocities[springs.begin]
        squared = (way * way).sum(axis=-1)
        tension = springs.stiffness * (1.0 - springs.length / squared**0.5)
        tension = tension + springs.damping * (way * approach).sum(axis=-1) / squared
        pull = tension[..., None] * way
        forces[springs.begin] += pull
        forces[springs.end] -= pull
    return forces


def elongations(positions: Any, plate: Sequence[Scalar]) -> list[Scalar]:
    """|d/r − 1| of every spring; positions as for :func:`spring_forces`."""
    shares: list[Scalar] = []
    for springs in springs_of(plate):
        way = positions[springs.end] - positions[springs.begin]
        shares += np.ravel(abs((way * way).sum(axis=-1) ** 0.5 / springs.length - 1.0)).tolist()
    return shares


@dataclass(frozen=True)
class PlateMechanics(Mechanics):
    """Newton's equations of the nodes, of state [q; v], node by node along the rows.

    A robot holds the point of its cell that is at its slot when the plate is at rest: by bilinear weights of the cell's
    four nodes, as in finite elements, which share what it exerts by the same weights. So force and torque balance
    however the plate turns, and a robot at a node holds that node alone.

    Its numbers are those of :func:`springs_of`, and four weights a robot.

    Attributes:
        rows: of nodes.
        columns: of nodes.
        corners: indices of the nodes of the cell that each robot holds, four a robot.
    """

    rows: int
    columns: int
    corners: tuple[tuple[int, ...], ...]

    @quiet
    def points(self, state: Any, robots: Sequence[int], numbers: Sequence[Any]) -> list[Motion]:
        """Places p = Σ w_k q_k, ṗ = Σ w_k v_k over the nodes of a robot's cell."""
        half = len(state) // 2
        positions, velocities = state[:half].reshape(-1, 2), state[half:].reshape(-1, 2)
        nodes = np.array([self.corners[j] for j in robots])
        weights = numbers[1].reshape(-1, 4)[list(robots), :, None]
        places, speeds = ((weights * array[nodes]).sum(axis=1).tolist() for array in (positions, velocities))
        return [(*place, *speed) for place, speed in zip(places, speeds, strict=True)]

    @quiet
    def accelerations(self, state: Any, forces: Sequence[Pair], numbers: Sequence[Any]) -> Any:
        """Of m v̇ = what the springs exert and, of the robots' forces what falls to the node."""
        positions, velocities = self._grids(state)
        plate, weights = numbers[0].tolist(), numbers[1].reshape(-1, 4, 1)
        total = spring_forces(positions, velocities, plate).reshape(-1, 2)
        np.add.at(total, np.array(self.corners), weights * np.array(forces)[:, None])
        return total.ravel() / plate[0]

    @quiet
    def pose(self, state: Any, numbers: Sequence[Any]) -> list[Scalar]:
        """Of the nodes' mean; the heading, within half a turn, is by which the plate at rest fits best (Procrustes).

        With r_k the place of a node at rest relative to the mean, and q_k that now: tan φ = Σ r_k × q_k / Σ r_k · q_k.
        """
        half = len(state) // 2
        positions, velocities = state[:half].reshape(-1, 2), state[half:].reshape(-1, 2)
        (x, y), (vx, vy) = ((array.sum(axis=0) * (2.0 / half)).tolist() for array in (positions, velocities))
        rest_x, rest_y = self._rest(*numbers[0].tolist()[-2:])

        def fit(array: Any) -> Pair:
            along = (rest_x * array[:, 0] + rest_y * array[:, 1]).sum()
            across = (rest_x * array[:, 1] - rest_y * array[:, 0]).sum()
            return along, across

        (along, across), (along_rate, across_rate) = fit(positions - [x, y]), fit(velocities)
        rate = (along * across_rate - across * along_rate) / (along * along + across * across)
        return [x, y, atan2(across, along), vx, vy, rate]

    def nodes(self, state: Any) -> Any:
        """Of its state, the places."""
        return state[: len(state) // 2]

    @quiet
    def strain(self, state: Any, stretches: Sequence[Pair], numbers: Sequence[Any]) -> Scalar:  # noqa: ARG002
        """The largest share by which any spring of the plate is longer or shorter than at rest."""
        positions, _ = self._grids(state)
        return largest(elongations(positions, numbers[0].tolist()))

    def _grids(self, state: Any) -> tuple[Any, Any]:
        positions, velocities = state.reshape(2, self.rows, self.columns, 2)
        return positions, velocities

    def _rest(self, width: Scalar, height: Scalar) -> tuple[Any, Any]:
        """Places of the nodes at rest relative to their mean (m), x and y."""
        row, column = np.divmod(np.arange(self.rows * self.columns), self.columns)
        return (column - (self.columns - 1) / 2) * width, (row - (self.rows - 1) / 2) * height
