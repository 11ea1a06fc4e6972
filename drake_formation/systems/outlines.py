"""Where a robot is from obstacles of any shape: points, segments and polygons, grown by a radius, that may move.

An obstacle is a row of numbers: its vertices (m, two each), its radius (m), and of each piece of its motion when it
begins and ends (s) and the velocity (m/s, two numbers). One vertex is the centre of a circle, two are the ends of a
segment, and more the corners of a polygon, counter-clockwise.
"""

from collections.abc import Iterator, Sequence

from drake_formation.systems.scalars import Scalar, at_least, at_most, chosen, lesser, positive_part

Layout = tuple[tuple[int, int], ...]
"""Of each obstacle the number of its vertices and of the pieces of its motion."""

Offset = tuple[Scalar, Scalar, Scalar]
"""Where a point is from the nearest point of an outline (m, x and y component), and what lies between that point and
the obstacle's surface (m): the clearance is the length less that."""

TINY = 1e-30
"""The least squared length of a segment that counts (m²); a shorter one is a point."""

ROUND = (1, 0)
"""A circle at rest."""


def circles(count: int) -> Layout:
    """The layout of some circles at rest."""
    return (ROUND,) * count


def offsets(x: Scalar, y: Scalar, time: Scalar, numbers: Sequence[Scalar], layout: Layout) -> Iterator[Offset]:
    """Where a point is from each of some obstacles.

    Args:
        x: position of the point (m), x component; a scalar or an array of floats.
        y: its y component (m).
        time: when (s).
        numbers: of all obstacles, one row after the other.
        layout: how many numbers each has.
    """
    for vertices, radius, motion in _rows(numbers, layout):
        px, py = x, y
        if motion:
            mx, my = _displacement(time, motion)
            px, py = x - mx, y - my
        if len(vertices) == 2:
            yield px - vertices[0], py - vertices[1], radius
        elif len(vertices) == 4:
            yield *from_segment(px, py, *vertices), radius
        else:
            yield _from_polygon(px, py, list(zip(vertices[::2], vertices[1::2], strict=True)), radius)


def _rows(numbers: Sequence[Scalar], layout: Layout) -> Iterator[tuple[Sequence[Scalar], Scalar, Sequence[Scalar]]]:
    """The vertices, the radius and the motion of each obstacle."""
    at = 0
    for vertices, pieces in layout:
        begin, radius = at, at + 2 * vertices
        at = radius + 1 + 4 * pieces
        yield numbers[begin:radius], numbers[radius], numbers[radius + 1 : at]


def _displacement(time: Scalar, motion: Sequence[Scalar]) -> tuple[Scalar, Scalar]:
    """How far an obstacle has moved (m)."""
    mx = my = 0.0
    for k in range(0, len(motion), 4):
        start, end, vx, vy = motion[k : k + 4]
        moving = lesser(at_least(time, start), end) - start
        mx, my = mx + vx * moving, my + vy * moving
    return mx, my


def squares(x: Scalar, y: Scalar, time: Scalar, numbers: Sequence[Scalar], layout: Layout) -> Iterator[Scalar]:
    """Squared distance of a point from each outline (m²); see :func:`offsets`."""
    for dx, dy, _ in offsets(x, y, time, numbers, layout):
        yield dx * dx + dy * dy


def from_segment(x: Scalar, y: Scalar, ax: Scalar, ay: Scalar, bx: Scalar, by: Scalar) -> tuple[Scalar, Scalar]:
    """Where a point is from the nearest point of the segment from a to b (m)."""
    dx, dy, ex, ey = x - ax, y - ay, bx - ax, by - ay
    share = lesser(positive_part((dx * ex + dy * ey) / at_least(ex * ex + ey * ey, TINY)), 1.0)
    return dx - share * ex, dy - share * ey


def _from_polygon(x: Scalar, y: Scalar, corners: list[tuple[Scalar, Scalar]], radius: Scalar) -> Offset:
    """Where a point is from the nearest edge of a polygon; inside it is turned outward, and the surface is beyond.

    Whether it is inside, its winding number says: how often the edges go round it, counted where they cross the line
    to its right, upward on its right side and downward as −1 (Sunday 2001).
    """
    inside, edges = 0.0, []
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        dx, dy = from_segment(x, y, ax, ay, bx, by)
        edges.append((dx * dx + dy * dy, dx, dy))
        rises = at_most(ay - y, 0.0) - at_most(by - y, 0.0)
        inside = inside + rises * (1.0 - at_most(rises * ((bx - ax) * (y - ay) - (x - ax) * (by - ay)), 0.0))
    least, nx, ny = _nearest(edges)
    outward = 1.0 - 2.0 * inside
    return outward * nx, outward * ny, radius + 2.0 * inside * least**0.5


def _nearest(edges: list[tuple[Scalar, Scalar, Scalar]]) -> tuple[Scalar, Scalar, Scalar]:
    """The first of the rows with the least first number; found in pairs, so that an expression is not deep."""
    if len(edges) == 1:
        return edges[0]
    first, second = _nearest(edges[: len(edges) // 2]), _nearest(edges[len(edges) // 2 :])
    others = (chosen(first[0], second[0], a, b) for a, b in zip(first[1:], second[1:], strict=True))
    return lesser(first[0], second[0]), *others
