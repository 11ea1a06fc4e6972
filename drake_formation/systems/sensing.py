"""Nearest-robot sensing: an obstacle is seen by the robot nearest to it alone (paper, Sec. 5.1)."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.scalars import Scalar, at_most
from drake_formation.systems.templates import block_template, in_double


def nearest(squared_distances: list[Scalar], robot: int) -> Scalar:
    """1 if no robot is nearer to the obstacle than this one, else 0; robots at the same distance both see it.

    Args:
        squared_distances: from every robot to the obstacle's centre (m²).
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
        obstacle 1 if the robot is the nearest to it, else 0. Parameter: 0, the obstacles' centres (m, two each).
        """

        def _construct(self, robots: int, obstacles: ArrayLike, *, converter: Any = None) -> None:
            """Make the sensing.

            Args:
                robots: number of robots N.
                obstacles: centre of each obstacle (m), shape (obstacles, 2).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (robots, obstacles)
            self._states = [self.DeclareVectorInputPort(f"state_{i + 1}", 4) for i in range(robots)]
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(obstacles)))
            prerequisites = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            count = len(np.reshape(obstacles, (-1, 2)))
            for i in range(robots):
                self.DeclareVectorOutputPort(f"sensed_{i + 1}", count, self._calc_sensed(i), prerequisites)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_sensed(self, robot: int) -> Any:
            def calc(context: Any, output: Any) -> None:
                positions = [port.Eval(context).tolist()[:2] for port in self._states]
                obstacles = context.get_numeric_parameter(0).CopyToVector().reshape(-1, 2).tolist()
                sensed = []
                for ox, oy in obstacles:
                    squared = [(x - ox) * (x - ox) + (y - oy) * (y - oy) for x, y in positions]
                    sensed.append(nearest(squared, robot))
                output.SetFromVector(np.array(sensed))

            return calc

    return Impl


NearestSensing = in_double(NearestSensing_)
