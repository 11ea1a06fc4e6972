"""The formation written by hand in numba, as one would without Drake: the yardstick for the compiled diagram.

The right-hand side is one loop over all pairs, one force a pair; the integrator is a plain adaptive
Dormand-Prince pair.
"""

import math

import numpy as np
from numba import njit

from drake_formation.parameters import block_parameters
from drake_formation.scenario import resolve

NUMPY = {"error_model": "numpy"}


def parameters(scenario):
    """Everything that the hand-written formation needs of a complete scenario in transport."""
    count = resolve(scenario).robots
    numbers = block_parameters(resolve(scenario))
    obstacles = np.array([[*o.position, o.radius] for o in scenario.avoidance.obstacles]).reshape(-1, 3)
    tracking = numbers["robot_1/tracking"][0]
    return (
        np.ascontiguousarray(resolve(scenario).slots),
        np.array(resolve(scenario).masses, dtype=float),
        np.array(tracking, dtype=float).reshape(2, 4),
        np.array(scenario.transport.goal, dtype=float),
        np.full((count, count), float(scenario.springs.stiffness)),
        np.full((count, count), float(scenario.springs.damping)),
        float(scenario.consensus.delta),
        float(scenario.consensus.delta_v),
        obstacles,
        scenario.avoidance.range,
        scenario.avoidance.gain,
    )


@njit(**NUMPY)
def slope(x, p, dx):
    """Time derivative of all robots."""
    slots, masses, gain, goal, stiffness, damping, delta, delta_v, obstacles, reach, push = p
    for i in range(len(masses)):
        qx, qy, vx, vy = x[4 * i], x[4 * i + 1], x[4 * i + 2], x[4 * i + 3]
        ex, ey = qx - goal[0] - slots[i, 0], qy - goal[1] - slots[i, 1]
        fx = -(gain[0, 0] * ex + gain[0, 1] * ey + gain[0, 2] * vx + gain[0, 3] * vy)
        fy = -(gain[1, 0] * ex + gain[1, 1] * ey + gain[1, 2] * vx + gain[1, 3] * vy)
        for k in range(len(obstacles)):
            ox, oy = qx - obstacles[k, 0], qy - obstacles[k, 1]
            distance = math.sqrt(ox * ox + oy * oy)
            clearance = distance - obstacles[k, 2]
            if clearance < reach:
                force = push * (1 / clearance - 1 / reach) / (clearance * clearance * distance)
                fx += force * ox
                fy += force * oy
        dx[4 * i], dx[4 * i + 1] = vx, vy
        dx[4 * i + 2], dx[4 * i + 3] = fx, fy
    for i in range(len(masses)):
        for j in range(i):
            rx, ry = x[4 * i] - x[4 * j], x[4 * i + 1] - x[4 * j + 1]
            wx, wy = x[4 * i + 2] - x[4 * j + 2], x[4 * i + 3] - x[4 * j + 3]
            hx, hy = slots[i, 0] - slots[j, 0], slots[i, 1] - slots[j, 1]
            square = rx * rx + ry * ry
            rest = math.sqrt(hx * hx + hy * hy)
            tension = stiffness[i, j] * (1 - rest / math.sqrt(square))
            tension += damping[i, j] * (rx * wx + ry * wy) / square
            fx = tension * rx + delta * (rx - hx) + delta_v * wx
            fy = tension * ry + delta * (ry - hy) + delta_v * wy
            dx[4 * i + 2] -= fx
            dx[4 * i + 3] -= fy
            dx[4 * j + 2] += fx
            dx[4 * j + 3] += fy
    for i in range(len(masses)):
        dx[4 * i + 2] /= masses[i]
        dx[4 * i + 3] /= masses[i]


@njit(**NUMPY)
def repeat_slope(times, x, p, dx):
    """The right-hand side many times over, without Python between."""
    for _ in range(times):
        slope(x, p, dx)
        x[0] += 1e-12 * dx[0]


@njit(**NUMPY)
def dormand_prince(x, end, p, accuracy, max_step):
    """Final state, steps accepted and derivatives evaluated."""
    n = len(x)
    x = x.copy()
    k = np.empty((7, n))
    y = np.empty(n)
    t, h, steps, evaluations = 0.0, 0.1 * max_step, 0, 1
    slope(x, p, k[0])
    while t < end:
        h = min(h, end - t)
        for i in range(n):
            y[i] = x[i] + h * k[0, i] / 5
        slope(y, p, k[1])
        for i in range(n):
            y[i] = x[i] + h * (3 / 40 * k[0, i] + 9 / 40 * k[1, i])
        slope(y, p, k[2])
        for i in range(n):
            y[i] = x[i] + h * (44 / 45 * k[0, i] - 56 / 15 * k[1, i] + 32 / 9 * k[2, i])
        slope(y, p, k[3])
        for i in range(n):
            y[i] = x[i] + h * (
                19372 / 6561 * k[0, i] - 25360 / 2187 * k[1, i] + 64448 / 6561 * k[2, i] - 212 / 729 * k[3, i]
            )
        slope(y, p, k[4])
        for i in range(n):
            y[i] = x[i] + h * (
                9017 / 3168 * k[0, i]
                - 355 / 33 * k[1, i]
                + 46732 / 5247 * k[2, i]
                + 49 / 176 * k[3, i]
                - 5103 / 18656 * k[4, i]
            )
        slope(y, p, k[5])
        for i in range(n):
            y[i] = x[i] + h * (
                35 / 384 * k[0, i]
                + 500 / 1113 * k[2, i]
                + 125 / 192 * k[3, i]
                - 2187 / 6784 * k[4, i]
                + 11 / 84 * k[5, i]
            )
        slope(y, p, k[6])
        evaluations += 6
        error = 0.0
        for i in range(n):
            e = h * (
                71 / 57600 * k[0, i]
                - 71 / 16695 * k[2, i]
                + 71 / 1920 * k[3, i]
                - 17253 / 339200 * k[4, i]
                + 22 / 525 * k[5, i]
                - k[6, i] / 40
            )
            error = max(error, abs(e) / accuracy)
        if error <= 1:
            t += h
            steps += 1
            for i in range(n):
                x[i] = y[i]
                k[0, i] = k[6, i]
        h = min(max_step, h * min(5.0, max(0.2, 0.9 * max(error, 1e-10) ** -0.2)))
    return x, steps, evaluations
