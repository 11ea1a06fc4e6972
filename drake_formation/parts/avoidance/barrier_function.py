"""A control barrier function over obstacles, and the least force that keeps it, in closed form."""

from pydrake.math import exp, log

from drake_formation.systems.scalars import Scalar, lesser, positive_part

TINY = 1e-30
"""Added to squares that may be zero where nothing follows from their quotient (m², or a pure number)."""

Pair = tuple[Scalar, Scalar]
Discs = list[list[Scalar]]
"""Centre and radius of each obstacle (m)."""


def smooth_barrier(
    position: Pair, velocity: Pair, discs: Discs, clearance: Scalar, rate: Scalar, sharpness: Scalar
) -> tuple[Scalar, Pair, Scalar]:
    """The barrier B over all obstacles, with what its rate of change is made of.

    Each obstacle has a distance to spare h_k = ‖q − o_k‖ − r_k − d, and B is the smooth minimum
    −ln(Σ exp(−κ b_k))/κ of b_k = h_k + ḣ_k/λ, which is below all of them, by ln(obstacles)/κ at the most (Glotfelter,
    Cortés & Egerstedt 2017 compose barriers by minima). At rest b_k = h_k. While B ≥ 0, no ḣ_k is below −λ h_k, so that
    no h_k that was positive ever becomes negative.

    Args:
        position: q of the robot (m).
        velocity: v of the robot (m/s).
        discs: the obstacles, one at least.
        clearance: d (m).
        rate: λ (1/s).
        sharpness: κ (1/m).

    Returns:
        B (m); the mean g of the directions n_k away from the obstacles, by the weights ∂B/∂b_k; and likewise the mean c
        of what the robot gains by going round them, v_t²/‖q − o_k‖ (m/s²). With an acceleration a of the robot,
        Ḃ = g·v + (c + g·a)/λ.
    """
    (x, y), (vx, vy) = position, velocity
    rows = []
    for ox, oy, radius in discs:
        dx, dy = x - ox, y - oy
        distance = (dx * dx + dy * dy + TINY) ** 0.5
        nx, ny = dx / distance, dy / distance
        across = nx * vy - ny * vx
        spare = distance - radius - clearance + (nx * vx + ny * vy) / rate
        rows.append((spare, nx, ny, across * across / distance))
    least = rows[0][0]
    for spare, *_ in rows[1:]:
        least = lesser(least, spare)  # the sum of exponentials neither overflows nor vanishes so
    total = gx = gy = gain = 0.0 * least
    for spare, nx, ny, round_it in rows:
        weight = exp(sharpness * (least - spare))
        total, gain = total + weight, gain + weight * round_it
        gx, gy = gx + weight * nx, gy + weight * ny
    return least - log(total) / sharpness, (gx / total, gy / total), gain / total


def barrier_force(
    position: Pair,
    velocity: Pair,
    others: Pair,
    discs: Discs,
    mass: Scalar,
    clearance: Scalar,
    rate: Scalar,
    sharpness: Scalar,
) -> Pair:
    """The least force that keeps Ḃ ≥ −λ B, in closed form.

    The quadratic program min ‖f‖² with one constraint linear in f (Ames et al. 2017, Sec. II-C) is a projection. For
    one obstacle the constraint is ḧ + 2λ ḣ + λ² h ≥ 0, the exponential barrier function of relative degree two with
    both poles at −λ (Nguyen & Sreenath 2016, Sec. III).

    While B ≥ 0 it can be met everywhere: where g = 0, between obstacles, Ḃ = c/λ ≥ 0 whatever the force. Then ‖f‖ is no
    more than the others' force and m λ ‖v‖ together.

    Args:
        position: q of the robot (m).
        velocity: v of the robot (m/s).
        others: all other forces on the robot (N).
        discs: the obstacles, one at least.
        mass: m (kg).
        clearance: d (m).
        rate: λ (1/s).
        sharpness: κ (1/m).

    Returns:
        Components of f (N).
    """
    barrier, (gx, gy), gain = smooth_barrier(position, velocity, discs, clearance, rate, sharpness)
    (vx, vy), (fx, fy) = velocity, others
    lacking = -(gain + (gx * fx + gy * fy) / mass + rate * (gx * vx + gy * vy) + rate * rate * barrier)
    push = mass * positive_part(lacking) / (gx * gx + gy * gy + TINY)
    return push * gx, push * gy
