"""Line of sight: which obstacles a robot sees past other robots and other obstacles, as a block."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.holding_sensing import PERIOD
from drake_formation.systems.outlines import Layout
from drake_formation.systems.sight_law import LOOK
from drake_formation.systems.templates import block_template, in_double


@block_template("LineOfSight_", __name__)
def LineOfSight_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The sensing as a template over double, AutoDiffXd and Expression; see :class:`LineOfSight`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Which robot sees which obstacle, looked at every ``PERIOD``, in double.

        Input ports: ``state_i`` of every robot (size 4). Output ports: ``visible_i`` of every robot: for each obstacle
        1 if the robot sees what is nearest to it of that, else 0, the block's discrete state. Parameters: 0, the
        numbers of the obstacles, as :mod:`drake_formation.systems.outlines` says; 1, the radius of each robot's
        footprint (m); 2, the layout of the first.
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
            self.sampled_law = LOOK
            robots = range(np.size(footprints))
            self._states = [self.DeclareVectorInputPort(f"state_{i + 1}", 4) for i in robots]
            for group in (obstacles, footprints, np.array(layout, dtype=float)):
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            for i in robots:
                self.DeclareStateOutputPort(f"visible_{i + 1}", self.DeclareDiscreteState(len(layout)))
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._look)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _look(self, context: Any, seen: Any) -> None:
            inputs = np.concatenate([port.Eval(context) for port in self._states])
            numbers = np.concatenate([context.get_numeric_parameter(k).CopyToVector() for k in range(3)])
            state = np.concatenate([seen.get_vector(k).CopyToVector() for k in range(len(self._states))])
            self.sampled_law(context.get_time(), inputs, state, numbers)
            for k, own in enumerate(np.split(state, len(self._states))):
                seen.set_value(k, own)

    return Impl


LineOfSight = in_double(LineOfSight_)
