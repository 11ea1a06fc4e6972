"""Line of sight: which obstacles a robot sees past other robots and other obstacles."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.holding_sensing import PERIOD
from drake_formation.systems.outlines import Layout, edges, from_segment, offsets
from drake_formation.systems.scalars import Scalar, at_most, lesser
from drake_formation.systems.templates import block_template, in_double

Line = tuple[Scalar, Scalar, Scalar, Scalar]
"""Where a segment begins and ends (m)."""


def blocked_by_disc(sight: Line, x: Scalar, y: Scalar, radius: Scalar) -> Scalar:
    """1 where a disc stands in a line of sight, else 0; a point, of radius 0, hides nothing."""
    dx, dy = from_segment(x, y, *sight)
    return 1.0 - at_most(radius * radius, dx * dx + dy * dy)


def blocked_by_edge(sight: Line, edge: Line, radius: Scalar) -> Scalar:
    """1 where a segment crosses a line of sight or comes nearer to it than a radius, else 0."""
    begins, ends = (sight[:2], sight[2:]), (edge[:2], edge[2:])
    apart = [from_segment(*place, *edge) for place in begins] + [from_segment(*place, *sight) for place in ends]
    nearest, *others = [dx * dx + dy * dy for dx, dy in apart]
    for squared in others:
        nearest = lesser(nearest, squared)
    near = 1.0 - at_most(radius * radius, nearest)
    clear = (1.0 - near) * (1.0 - _on_both_sides(edge, begins) * _on_both_sides(sight, ends))
    return 1.0 - clear


def _on_both_sides(line: Line, places: Sequence[tuple[Scalar, Scalar]]) -> Scalar:
    """1 where two places lie on different sides of a straight line through a segment, else 0."""
    ax, ay, bx, by = line
    first, second = [(bx - ax) * (y - ay) - (by - ay) * (x - ax) for x, y in places]
    return 1.0 - at_most(-first * second, 0.0)


def visible(
    robot: int,
    positions: Sequence[tuple[Scalar, Scalar]],
    footprints: Sequence[Scalar],
    time: Scalar,
    numbers: Sequence[Scalar],
    layout: Layout,
) -> list[Scalar]:
    """1 for each obstacle of which a robot sees what is nearest to it, else 0.

    Args:
        robot: index of the robot.
        positions: of all robots (m).
        footprints: radius of each robot (m).
        time: when (s).
        numbers: the numbers of the obstacles.
        layout: of those numbers.
    """
    x, y = positions[robot]
    discs = [(*place, radius) for place, radius in zip(positions, footprints, strict=True)]
    del discs[robot]
    outlines = list(edges(time, numbers, layout))
    found = []
    for k, (dx, dy, _) in enumerate(offsets(x, y, time, numbers, layout)):
        sight = (x, y, x - dx, y - dy)
        clear: Scalar = 1.0
        for disc in discs:
            clear = clear * (1.0 - blocked_by_disc(sight, *disc))
        for lines, radius in outlines[:k] + outlines[k + 1 :]:
            for line in lines:
                clear = clear * (1.0 - blocked_by_edge(sight, line, radius))
        found.append(clear)
    return found


@block_template("LineOfSight_", __name__)
def LineOfSight_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The sensing as a template over double, AutoDiffXd and Expression; see :class:`LineOfSight`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Which robot sees which obstacle, looked at every ``PERIOD``.

        Input ports: ``state_i`` of every robot (size 4). Output ports: ``visible_i`` of every robot: for each obstacle
        1 if the robot sees it, else 0, the block's discrete state. Parameters: 0, the numbers of the obstacles, as
        :mod:`drake_formation.systems.outlines` says; 1, the radius of each robot's footprint (m).
        """

        def _construct(
            self, obstacles: ArrayLike, footprints: ArrayLike, layout: Layout, *, converter: Any = None
        ) -> None:
            """Make the sensing.

            Args:
                obstacles: the numbers of the obstacles.
                footprints: radius of each robot's footprint (m), shape (N,).
                layout: of the obstacles' numbers.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (obstacles, footprints, layout)
            self._layout = layout
            robots = range(np.size(footprints))
            self._states = [self.DeclareVectorInputPort(f"state_{i + 1}", 4) for i in robots]
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(obstacles)))
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(footprints)))
            for i in robots:
                self.DeclareStateOutputPort(f"visible_{i + 1}", self.DeclareDiscreteState(len(layout)))
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._look)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _look(self, context: Any, seen: Any) -> None:
            positions = [tuple(port.Eval(context).tolist()[:2]) for port in self._states]
            obstacles, footprints = (context.get_numeric_parameter(k).CopyToVector().tolist() for k in range(2))
            time = context.get_time()
            for i in range(len(positions)):
                seen.set_value(i, np.array(visible(i, positions, footprints, time, obstacles, self._layout)))

    return Impl


LineOfSight = in_double(LineOfSight_)
