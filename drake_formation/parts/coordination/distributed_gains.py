"""Distributed LQR for identical, dynamically decoupled systems (Borrelli and Keviczky, 2008).

For N_L systems ẋ = A x + B u that all see each other, the cost

    ∫ Σ_i (x_iᵀ Q₁ x_i + u_iᵀ R u_i) + Σ_{i<j} (x_i − x_j)ᵀ Q₂ (x_i − x_j) dt

is minimal with u_i = −K₁ x_i − K₂ Σ_j (x_i − x_j). By symmetry its Riccati equation falls apart into two of one
system's size: K₁ belongs to (Q₁, R), and K₁ + N_L K₂ to (Q₁ + N_L Q₂, R) (their Theorem 1, with N_L P̃₂ = P₁ − P₂ for
the solutions P₁ and P₂ of the two). For a graph of more systems whose degrees are at most d, N_L = d + 1 and the gain
is

    K = I ⊗ K₁ + M ⊗ K₂,  M = a L (L the graph's Laplacian),

which is stable if every eigenvalue of M but the zero is above N_L/2 (their Theorem 3: an LQR has infinite gain margin
upwards and one half downwards). Exactly, it is stable if A − B (K₁ + μ K₂) is for every eigenvalue μ of M.

Source: F. Borrelli and T. Keviczky, "Distributed LQR design for identical dynamically decoupled systems", IEEE
Transactions on Automatic Control 53(8), 2008.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.parts.tracking.lqr import lqr_gain, robot_matrices

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DistributedGains:
    """The gains of a design.

    Attributes:
        local: K₁, shape (2, 4).
        relative: K₂ for every neighbour, scale included, shape (2, 4).
        systems: N_L, the number of systems of the problem solved: the largest degree plus one.
        scale: a, the weight of the Laplacian in M.
        sufficient_scale: the a above which the theorem alone guarantees stability, N_L/(2 λ₂); 0 for a single robot.
        decay: least decay rate of the robots without the object (1/s), from the spectrum; stable if positive.
    """

    local: Array
    relative: Array
    systems: int
    scale: float
    sufficient_scale: float
    decay: float


def distributed_gains(
    mass: float,
    laplacian: Array,
    state_cost: Array,
    input_cost: Array,
    relative_cost: Array,
    *,
    scale: float | None = None,
    plant: tuple[Array, Array] | None = None,
) -> DistributedGains:
    """Design a distributed LQR for a connected graph.

    Args:
        mass: of each robot (kg).
        laplacian: L, shape (N, N), symmetric.
        state_cost: Q₁, shape (4, 4).
        input_cost: R, shape (2, 2).
        relative_cost: Q₂, shape (4, 4), positive semi-definite.
        scale: a in M = a L; if not given, 1 where the exact spectrum shows that to be stable, else what the theorem
            asks for.
        plant: A (4, 4) and B (4, 2) whose spectrum to look at; those of a point mass of the mass if not given.
    """
    a, b = plant or robot_matrices(mass)
    spectrum = np.linalg.eigvalsh(laplacian)
    systems = round(float(np.diag(laplacian).max())) + 1
    local = lqr_gain(mass, state_cost, input_cost)
    relative = (lqr_gain(mass, state_cost + systems * relative_cost, input_cost) - local) / systems
    sufficient = float(systems / (2 * spectrum[1:].min(initial=np.inf)))

    def slowest(weight: float) -> float:
        return min(decay_rate(a - b @ (local + weight * mu * relative)) for mu in spectrum)

    if scale is None:
        scale = 1.0 if slowest(1.0) > 0 else 1.01 * sufficient
    return DistributedGains(local, scale * relative, systems, scale, sufficient, slowest(scale))


def decay_rate(loop: Array) -> float:
    """The least rate at which a motion ẋ = A x decays (1/s); negative where one grows."""
    return float(-np.linalg.eigvals(loop).real.max())
