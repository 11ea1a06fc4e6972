"""Which changes of shape distances between robots hold: the rigidity matrix of a framework (Asimow and Roth, 1978)."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.graphs import Edge

Array = NDArray[np.float64]

ROUNDING = 1e-12
"""Size, relative to the largest, below which an eigenvalue is what rounding leaves of a zero."""


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
    if not edges:
        return 0
    matrix = rigidity_matrix(slots, edges)
    values = np.linalg.eigvalsh((matrix.T @ matrix).toarray())
    return int(np.sum(values > ROUNDING * values[-1]))


def rigid_rank(robots: int) -> int:
    """The rank of a framework that is rigid in the plane, 2N − 3: it leaves two translations and one rotation."""
    return max(2 * robots - 3, 0)
