"""The linear model of the whole formation about its slots: point masses, and the object's springs between them.

Deviations of all robots from their slots are the state ε = [ε_1; …; ε_N], ε_i = [q; v] (m, m/s), and their control
forces the input u (N): ε̇ = A ε + B u (paper, Eqs. 4-7).
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from pydrake.autodiffutils import ExtractGradient, InitializeAutoDiff

from drake_formation.formation.formation import Formation
from drake_formation.parts.roles import STATE
from drake_formation.parts.tracking.lqr import robot_matrices

Array = NDArray[np.float64]


def formation_matrices(masses: Array) -> tuple[Array, Array]:
    """A (4N, 4N) and B (4N, 2N) of robots of some masses (kg), shape (N,), without the object."""
    a, b = robot_matrices(1.0)
    plants, forces = np.kron(np.eye(len(masses)), a), np.kron(np.diag(1.0 / masses), b)
    return plants.astype(np.float64), forces.astype(np.float64)


def spring_matrix(formation: Formation) -> Array:
    """What the object's springs add to A, linearized by Drake about the robots in their slots, shape (4N, 4N).

    Two robots with one slot give no numbers: a spring between them has no direction.
    """
    result = np.zeros((STATE * formation.robots, STATE * formation.robots))
    for i, others in enumerate(formation.springs.neighbours):
        accelerations = slice(STATE * i + 2, STATE * (i + 1))
        for j, edge in zip(others, formation.springs.incident(i), strict=True):
            push = spring_slope(formation, edge, formation.slots[i] - formation.slots[j]) / formation.masses[i]
            result[accelerations, STATE * i : STATE * (i + 1)] -= push
            result[accelerations, STATE * j : STATE * (j + 1)] += push
    return result


def spring_slope(formation: Formation, edge: int, displacement: Array) -> Array:
    """Slope of F_ij by the relative state of robots i and j in their slots, shape (2, 4), in N/m and N s/m.

    Args:
        formation: whose law to differentiate.
        edge: row of the robots in ``formation.springs.pairs``.
        displacement: h_i − h_j (m), shape (2,).
    """
    (numbers,) = formation.parts["spring"][edge].numbers(formation, edge)
    relative = InitializeAutoDiff(np.concatenate([displacement, np.zeros(2)])).ravel()
    at_rest = displacement * formation.elongations[edge]
    force = formation.law.law(*relative, *numbers.tolist(), *at_rest.tolist())
    slope: Array = ExtractGradient(np.array(force).reshape(2, 1))
    return slope


def block_diagonal(blocks: Iterable[Array]) -> Array:
    """Square matrices of one size along a diagonal, zeros elsewhere."""
    stacked = np.array(list(blocks))
    count, size, _ = stacked.shape
    result = np.zeros((count, size, count, size))
    result[np.arange(count), :, np.arange(count), :] = stacked
    return result.reshape(count * size, count * size)
