"""The ways in which a formation can move, as subspaces of the robots' displacements.

A displacement of all robots has 2N components. They split orthogonally into four parts:

- ``centre``: all robots move alike (2 dimensions); neither springs nor consensus resist.
- ``rotation``: the formation turns as a rigid body (1 dimension); springs along the line between robots let it.
- ``stretch``: what else the springs resist.
- ``consensus``: the rest, changes of shape that stretch no spring and are left to consensus alone.
"""

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import STATES, Array, LinearFormation

PARTS = ("centre", "rotation", "stretch", "consensus")

ROUNDING = 1e-9
"""Relative size below which a number is what rounding leaves of a zero."""


def positions(robots: int) -> NDArray[np.int64]:
    """Where x and y of every robot stand in the state, shape (2N,)."""
    result: NDArray[np.int64] = np.arange(STATES * robots).reshape(robots, STATES)[:, :2].ravel()
    return result


def velocities(robots: int) -> NDArray[np.int64]:
    """Where the velocities of every robot stand in the state, shape (2N,)."""
    return positions(robots) + 2


def spring_stiffness(formation: LinearFormation) -> Array:
    """Stiffness matrix of the object (N/m), shape (2N, 2N): it pulls with −K q. Read off the linearized diagram."""
    return _onto_forces(formation, positions(formation.robots))


def spring_damping(formation: LinearFormation) -> Array:
    """Damping matrix of the object (N s/m), shape (2N, 2N)."""
    return _onto_forces(formation, velocities(formation.robots))


def _onto_forces(formation: LinearFormation, columns: NDArray[np.int64]) -> Array:
    """Forces are accelerations times masses, and B holds the masses' inverses."""
    onto_velocities = velocities(formation.robots)
    forces = np.linalg.solve(formation.B[onto_velocities], formation.springs[np.ix_(onto_velocities, columns)])
    return np.asarray(-forces, dtype=float)


def rotation(slots: Array) -> Array:
    """Displacement of every robot as the formation turns about its centroid, of length 1, shape (2N,); 0 for N = 1."""
    x, y = (slots - slots.mean(axis=0)).T
    turned = np.column_stack([-y, x]).ravel()
    result: Array = turned / max(float(np.linalg.norm(turned)), 1e-300)
    return result


def parts(formation: LinearFormation) -> dict[str, Array]:
    """Orthonormal bases of the four parts, each of shape (2N, dimensions); together they span all displacements."""
    robots = formation.robots
    centre = np.kron(np.ones((robots, 1)), np.eye(2)) / np.sqrt(robots)
    turning = rotation(formation.resolved.slots)[:, None] if robots > 1 else np.zeros((2, 0))
    rigid = np.hstack([centre, turning])
    others = _complement(rigid)
    resisted, vectors = np.linalg.eigh(others.T @ _scaled_springs(formation) @ others)
    stretched = resisted > ROUNDING
    return {
        "centre": centre,
        "rotation": turning,
        "stretch": others @ vectors[:, stretched],
        "consensus": others @ vectors[:, ~stretched],
    }


def _scaled_springs(formation: LinearFormation) -> Array:
    """Stiffness and damping together, each with entries of at most 1: what a spring resists in any way."""
    both = [spring_stiffness(formation), spring_damping(formation)]
    result: Array = sum((m / np.abs(m).max() for m in both if m.any()), np.zeros_like(both[0]))
    return (result + result.T) / 2


def _complement(basis: Array) -> Array:
    """Orthonormal basis of what is orthogonal to some orthonormal columns."""
    complete, _ = np.linalg.qr(basis, mode="complete")
    result: Array = complete[:, basis.shape[1] :]
    return result
