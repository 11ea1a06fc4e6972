"""Which obstacles robots see past other robots and other obstacles: a law on plain arrays.

The functions are in the Python that numba compiles; :data:`LOOK` is the law. Numbers are those of all obstacles, as
:mod:`drake_formation.systems.outlines` says, then the radius of each robot (m), then the layout: of each obstacle the
number of its vertices and of the pieces of its motion. What is behind what goes by exact comparisons, which have no
derivative that a symbol could carry.
"""

import numpy as np
from numpy.typing import NDArray

from drake_formation.systems.sampled_law import SampledLaw

Array = NDArray[np.float64]


def look(time: float, inputs: Array, state: Array, numbers: Array) -> None:
    """Look which robot sees what is nearest to it of which obstacle.

    Args:
        time: when (s).
        inputs: the states of all robots, four numbers each (m, m/s).
        state: for each robot 1 for each obstacle that it sees, else 0; updated.
        numbers: see above.
    """
    robots = inputs.size // 4
    count = state.size // robots
    for robot in range(robots):
        x, y = inputs[4 * robot], inputs[4 * robot + 1]
        for obstacle in range(count):
            px, py = nearest_point(x, y, obstacle, time, numbers, count)
            seen = 1.0
            for other in range(robots):
                radius = numbers[numbers.size - 2 * count - robots + other]
                place = inputs[4 * other], inputs[4 * other + 1]
                if other != robot and squared_distance(place[0], place[1], x, y, px, py) < radius * radius:
                    seen = 0.0
            for other in range(count):
                if other != obstacle and hides(x, y, px, py, other, time, numbers, count):
                    seen = 0.0
            state[robot * count + obstacle] = seen


def nearest_point(x: float, y: float, obstacle: int, time: float, numbers: Array, count: int) -> tuple[float, float]:
    """What of an obstacle's edges is nearest to a place (m)."""
    least, found = np.inf, (x, y)
    for edge in range(edges(obstacle, numbers, count)):
        ax, ay, bx, by = ends(obstacle, edge, time, numbers, count)
        share = share_along(x, y, ax, ay, bx, by)
        px, py = ax + share * (bx - ax), ay + share * (by - ay)
        squared = (x - px) ** 2 + (y - py) ** 2
        if squared < least:
            least, found = squared, (px, py)
    return found


def hides(x: float, y: float, px: float, py: float, obstacle: int, time: float, numbers: Array, count: int) -> bool:
    """Whether an obstacle stands between two places (m); a point, of radius 0, hides nothing."""
    radius = numbers[row(obstacle, numbers, count) + 2 * int(numbers[numbers.size - 2 * count + 2 * obstacle])]
    for edge in range(edges(obstacle, numbers, count)):
        ax, ay, bx, by = ends(obstacle, edge, time, numbers, count)
        near = min(
            squared_distance(x, y, ax, ay, bx, by),
            squared_distance(px, py, ax, ay, bx, by),
            squared_distance(ax, ay, x, y, px, py),
            squared_distance(bx, by, x, y, px, py),
        )
        crossed = between(ax, ay, bx, by, x, y, px, py) and between(x, y, px, py, ax, ay, bx, by)
        if near < radius * radius or crossed:
            return True
    return False


def between(ax: float, ay: float, bx: float, by: float, x: float, y: float, px: float, py: float) -> bool:
    """Whether the straight line through a segment, the first, separates two places."""
    first = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    second = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
    return first * second < 0.0


def squared_distance(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Squared distance of a place from a segment (m²)."""
    share = share_along(x, y, ax, ay, bx, by)
    return (x - ax - share * (bx - ax)) ** 2 + (y - ay - share * (by - ay)) ** 2


def share_along(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """How far along a segment its nearest point to a place is, from 0 to 1; 0 where it has no length."""
    squared = (bx - ax) ** 2 + (by - ay) ** 2
    if squared == 0.0:
        return 0.0
    return min(max(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / squared, 0.0), 1.0)


def row(obstacle: int, numbers: Array, count: int) -> int:
    """Where the numbers of an obstacle begin."""
    layout, at = numbers.size - 2 * count, 0
    for before in range(obstacle):
        at += 2 * int(numbers[layout + 2 * before]) + 1 + 4 * int(numbers[layout + 2 * before + 1])
    return at


def edges(obstacle: int, numbers: Array, count: int) -> int:
    """How many edges an obstacle has: one where it is a circle, which is its centre, or a segment."""
    vertices = int(numbers[numbers.size - 2 * count + 2 * obstacle])
    return vertices if vertices > 2 else 1


def ends(obstacle: int, edge: int, time: float, numbers: Array, count: int) -> tuple[float, float, float, float]:
    """Where an edge of an obstacle begins and ends at a time (m)."""
    layout, at = numbers.size - 2 * count + 2 * obstacle, row(obstacle, numbers, count)
    vertices, pieces = int(numbers[layout]), int(numbers[layout + 1])
    mx, my = 0.0, 0.0
    for piece in range(pieces):
        k = at + 2 * vertices + 1 + 4 * piece
        moving = min(max(time, numbers[k]), numbers[k + 1]) - numbers[k]
        mx, my = mx + numbers[k + 2] * moving, my + numbers[k + 3] * moving
    a, b = at + 2 * edge, at + 2 * ((edge + 1) % vertices)
    return numbers[a] + mx, numbers[a + 1] + my, numbers[b] + mx, numbers[b + 1] + my


LOOK = SampledLaw(look, nearest_point, hides, between, squared_distance, share_along, row, edges, ends)
"""The law."""
