"""Which changes of shape distances between robots hold: the rigidity matrix of a framework (Asimow and Roth, 1978).

In the plane 2N − 3 independent distances hold the shape of N robots (Laman, 1970). All here is to first order: what is
called flexible can be moved by small distances at no cost, even where larger ones meet resistance.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.graphs import Edge

Array = NDArray[np.float64]

ROUNDING = 1e-12
"""Size, relative to the largest, below which an eigenvalue is what rounding leaves of a zero."""


@dataclass(frozen=True)
class Rigidity:
    """What distances along some edges hold of a shape.

    Attributes:
        robots: number of robots N.
        edges: how many distances are held.
        rank: how many of them are independent, the rank of the rigidity matrix R.
        generic_rank: how many would be with the robots in general position; where they are in a special one, such as on
            a line, it may be more.
        softest: the smallest eigenvalue of RᵀR over all changes of shape (Zelazo et al., 2012): springs of k N/m along
            the edges resist every one with at least k times this; 0 where one is free.
    """

    robots: int
    edges: int
    rank: int
    generic_rank: int
    softest: float

    @property
    def needed(self) -> int:
        """Laman's count, how many independent distances hold the shape."""
        return rigid_rank(self.robots)

    @property
    def rigid(self) -> bool:
        """Whether the shape is held."""
        return self.rank == self.needed

    @property
    def minimally_rigid(self) -> bool:
        """Whether it is and no distance can be spared."""
        return self.rigid and self.edges == self.needed

    @property
    def generically_rigid(self) -> bool:
        """Whether the shape would be held with the robots in general position."""
        return self.generic_rank == self.needed

    @property
    def mechanisms(self) -> int:
        """Independent changes of shape that are free."""
        return self.needed - self.rank

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "edges": self.edges,
            "rigidity_rank": self.rank,
            "laman_count": self.needed,
            "mechanisms": self.mechanisms,
            "rigid": self.rigid,
            "minimally_rigid": self.minimally_rigid,
            "rigid_in_general_position": self.generically_rigid,
            "smallest_eigenvalue": self.softest,
        }


def rigidity(slots: Array, edges: list[Edge]) -> Rigidity:
    """What distances along some edges hold of a formation's shape.

    Args:
        slots: slots of the robots (m), shape (N, 2).
        edges: pairs of robots from 0, each once.
    """
    robots = len(slots)
    values = squared_changes(slots, edges)
    rank, needed = _count(values), rigid_rank(robots)
    anywhere = np.random.default_rng(0).uniform(size=slots.shape)
    return Rigidity(
        robots=robots,
        edges=len(edges),
        rank=rank,
        generic_rank=max(rank, rigidity_rank(anywhere, edges)),
        softest=float(values[-needed]) if needed and rank == needed else 0.0,
    )


def rigidity_matrix(slots: Array, edges: list[Edge]) -> Any:
    """Change of every edge's length with the displacement of every robot, a sparse array of shape (edges, 2N).

    Args:
        slots: slots of the robots (m), shape (N, 2).
        edges: pairs of robots from 0.
    """
    from scipy.sparse import csr_array  # slow to import

    ends = np.array(edges, dtype=np.int64).reshape(-1, 2)
    apart = slots[ends[:, 0]] - slots[ends[:, 1]]
    along = apart / np.linalg.norm(apart, axis=1, keepdims=True)
    columns = 2 * ends[:, [0, 0, 1, 1]] + [0, 1, 0, 1]
    rows = np.repeat(np.arange(len(ends)), 4)
    return csr_array((np.hstack([along, -along]).ravel(), (rows, columns.ravel())), (len(ends), 2 * len(slots)))


def rigidity_rank(slots: Array, edges: list[Edge]) -> int:
    """Independent changes of length, the rank of the rigidity matrix R; as that of RᵀR, which edges do not enlarge."""
    return _count(squared_changes(slots, edges))


def squared_changes(slots: Array, edges: list[Edge]) -> Array:
    """Eigenvalues of RᵀR, ascending, shape (2N,): the squared changes of length of unit displacements of all robots."""
    if not edges:
        return np.zeros(2 * len(slots))
    matrix = rigidity_matrix(slots, edges)
    values: Array = np.linalg.eigvalsh((matrix.T @ matrix).toarray())
    return values


def _count(values: Array) -> int:
    return int(np.sum(values > ROUNDING * values[-1]))


def rigid_rank(robots: int) -> int:
    """The rank of a framework that is rigid in the plane, 2N − 3: it leaves two translations and one rotation."""
    return max(2 * robots - 3, 0)
