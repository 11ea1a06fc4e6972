"""Nearest-robot sensing: an obstacle is seen by the robot nearest to it alone (paper, Sec. 5.1)."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.outlines import Layout, circles, squares
from drake_formation.systems.scalars import Scalar, at_most
from drake_formation.systems.templates import block_template, in_double


def nearest(squared_distances: list[Scalar], robot: int) -> Scalar:
    """1 if no robot is nearer to the obstacle than this one, else 0; robots at the same distance both see it.

    Args:
        squared_distances: from every robot to the obstacle's centre or outline (m²).
        robot: index of the robot in that list.
    """
    result: Scalar = 1.0
    for other, distance in enumerate(squared_distances):
        if other != robot:
            result = result * at_most(squared_distances[robot], distance)
    return result


@block_template("NearestSensing_", __name__)
def NearestSensing_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The sensing as a template over double, AutoDiffXd and Expression; see :class:`NearestSensing`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Which robot sees which obstacle.

        Input ports: ``state_i`` of every robot (size 4). Output ports: ``sensed_i`` of every robot: for each
        obstacle 1 if the robot is the nearest to it, else 0; to the middle of a round one and the outline of others.
        Parameter: 0, the numbers of the obstacles, as :mod:`drake_formation.systems.outlines` says.
        """

        def _construct(
            self, robots: int, obstacles: ArrayLike, layout: Layout | None = None, *, converter: Any = None
        ) -> None:
            """Make the sensing.

            Args:
                robots: number of robots N.
                obstacles: the numbers of the obstacles; for circles centre and radius (m), shape (obstacles, 3).
                layout: of those numbers; circles at rest where there is none.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (robots, obstacles, layout)
            self._layout = circles(np.size(obstacles) // 3) if layout is None else layout
            self._moving = any(pieces for _, pieces in self._layout)
            self._states = [self.DeclareVectorInputPort(f"state_{i + 1}", 4) for i in range(robots)]
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(obstacles)))
            prerequisites = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            if self._moving:
                prerequisites.add(self.time_ticket())
            for i in range(robots):
                count = len(self._layout)
                self.DeclareVectorOutputPort(f"sensed_{i + 1}", count, self._calc_sensed(i), prerequisites)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_sensed(self, robot: int) -> Any:
            def calc(context: Any, output: Any) -> None:
                positions = [port.Eval(context).tolist()[:2] for port in self._states]
                obstacles = context.get_numeric_parameter(0).CopyToVector().tolist()
                time = context.get_time() if self._moving else 0.0
                columns = zip(*(squares(x, y, time, obstacles, self._layout) for x, y in positions), strict=True)
                output.SetFromVector(np.array([nearest(list(squared), robot) for squared in columns]))

            return calc

    return Impl


NearestSensing = in_double(NearestSensing_)
