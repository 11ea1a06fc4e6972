"""Nearest-robot sensing with hysteresis: who sees an obstacle keeps it until another robot is clearly nearer."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.outlines import Layout, circles, squares
from drake_formation.systems.scalars import Scalar, at_least, at_most, lesser
from drake_formation.systems.sensing import nearest
from drake_formation.systems.templates import block_template, in_double

PERIOD = 0.05
"""How often robots compare their distances (s)."""


def next_holders(distances: list[Scalar], holding: list[Scalar], margin: Scalar) -> list[Scalar]:
    """1 for each robot that sees an obstacle from now on, else 0.

    Those that hold it go on, unless another is nearer than they are by more than the margin, or nobody holds it: then
    the nearest does, or all nearest where several are equally near.

    Args:
        distances: from every robot to the obstacle's centre or outline (m).
        holding: 1 for each robot that saw it until now, else 0.
        margin: how much nearer (m).
    """
    holders = sum(holding)
    own = sum(d * held for d, held in zip(distances, holding, strict=True)) / at_least(holders, 1.0)
    least = distances[0]
    for distance in distances[1:]:
        least = lesser(least, distance)
    kept = at_most(1.0, holders) * at_most(own - least, margin)
    return [kept * held + (1.0 - kept) * nearest(distances, i) for i, held in enumerate(holding)]


@block_template("HoldingSensing_", __name__)
def HoldingSensing_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The sensing as a template over double, AutoDiffXd and Expression; see :class:`HoldingSensing`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Which robot sees which obstacle, compared every ``PERIOD``.

        Input ports: ``state_i`` of every robot (size 4). Output ports: ``sensed_i`` of every robot: for each obstacle 1
        if the robot sees it, else 0, the block's discrete state. Parameters: 0, the numbers of the obstacles, as
        :mod:`drake_formation.systems.outlines` says; 1, the margin (m).
        """

        def _construct(
            self,
            robots: int,
            obstacles: ArrayLike,
            margin: ArrayLike,
            layout: Layout | None = None,
            *,
            converter: Any = None,
        ) -> None:
            """Make the sensing.

            Args:
                robots: number of robots N.
                obstacles: the numbers of the obstacles; for circles centre and radius (m), shape (obstacles, 3).
                margin: how much nearer a robot must be to take over (m), shape (1,).
                layout: of those numbers; circles at rest where there is none.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (robots, obstacles, margin, layout)
            self._layout = circles(np.size(obstacles) // 3) if layout is None else layout
            self._states = [self.DeclareVectorInputPort(f"state_{i + 1}", 4) for i in range(robots)]
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(obstacles)))
            self.DeclareNumericParameter(BasicVector_[T](margin))
            for i in range(robots):
                self.DeclareStateOutputPort(f"sensed_{i + 1}", self.DeclareDiscreteState(len(self._layout)))
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._compare)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _compare(self, context: Any, held: Any) -> None:
            positions = [port.Eval(context).tolist()[:2] for port in self._states]
            obstacles = context.get_numeric_parameter(0).CopyToVector().tolist()
            (margin,) = context.get_numeric_parameter(1).CopyToVector().tolist()
            robots = range(len(positions))
            holding = [context.get_discrete_state(i).CopyToVector().tolist() for i in robots]
            time = context.get_time()
            rows = [[s**0.5 for s in squares(x, y, time, obstacles, self._layout)] for x, y in positions]
            columns = []
            for k, distances in enumerate(zip(*rows, strict=True)):
                columns.append(next_holders(list(distances), [holding[i][k] for i in robots], margin))
            for i in robots:
                held.set_value(i, np.array([column[i] for column in columns]))

    return Impl


HoldingSensing = in_double(HoldingSensing_)
