"""Springs on displacements, as the paper writes them in its linear model (Eqs. 4-7)."""

from drake_formation.parts.registry import part
from drake_formation.parts.springs.hookean import Spring
from drake_formation.systems.scalars import Scalar


def linear_spring_force(
    dx: Scalar, dy: Scalar, dvx: Scalar, dvy: Scalar, stiffness: Scalar, damping: Scalar, hx: Scalar, hy: Scalar
) -> tuple[Scalar, Scalar]:
    """Force F_ij of a spring that resists rotation too (paper, Eqs. 4-7).

    F_ij = k ((q_i − h_i) − (q_j − h_j)) + c (v_i − v_j). Arguments and result as in
    :func:`drake_formation.parts.springs.hookean.hookean_spring_force`.
    """
    return stiffness * (dx - hx) + damping * dvx, stiffness * (dy - hy) + damping * dvy


@part("spring", kind="linear")
class Linear(Spring):
    """Springs that resist rotation too (paper, Eqs. 4-7)."""

    law = staticmethod(linear_spring_force)
