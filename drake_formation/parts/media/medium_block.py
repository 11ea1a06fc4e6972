"""A medium that all channels share, as a block."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.parts.media.access import STATE_PORT, TRAFFIC_PORT
from drake_formation.parts.media.medium_law import SHARE
from drake_formation.systems.templates import block_template, in_double


@block_template("Medium_", __name__)
def Medium_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The medium as a template over double, AutoDiffXd and Expression; see :class:`Medium`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Airtime for which channels compete.

        Input ports: ``traffic_k`` of every channel k from 1, whose first number is how many packets have been offered,
        and ``state_j`` of every robot (m, m/s). Output ports: ``through_k`` for every channel (number of the packet
        carried last and when it was through (s), the same of the one carried before that, and the number up to which
        all are carried or dropped; size 5), and ``airtime`` (packets offered, carried and dropped so far, frames that
        collided, and the airtime of all frames (s); size 5). Discrete state: what is counted, what the medium
        remembers, what it reports to every channel, and what it knows of every station. Parameters: 0, the settings;
        1, channels; 2, stations.
        """

        def _construct(
            self,
            timing: tuple[float, float],
            robots: int,
            numbers: tuple[ArrayLike, ...],
            start: tuple[ArrayLike, ...],
            *,
            converter: Any = None,
        ) -> None:
            """Make the medium.

            Args:
                timing: how often it is worked out what becomes of packets, and when first (s).
                robots: number of robots N.
                numbers: the parameters.
                start: the groups of discrete state at the start.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (timing, robots, numbers, start)
            channels = len(start) - 3
            self.kind = timing, robots, channels  # all else that it computes with is a parameter
            self.sampled_law = SHARE
            ports = [(f"traffic_{k + 1}", TRAFFIC_PORT) for k in range(channels)]
            ports += [(f"state_{j + 1}", STATE_PORT) for j in range(robots)]
            self._inputs = [self.DeclareVectorInputPort(name, size) for name, size in ports]
            for group in numbers:
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            counts, _, *reports = [self.DeclareDiscreteState(BasicVector_[T](np.ravel(group))) for group in start]
            self.DeclarePeriodicDiscreteUpdateEvent(*timing, self._share)
            for k in range(channels):
                self.DeclareStateOutputPort(f"through_{k + 1}", reports[k])
            self.DeclareStateOutputPort("airtime", counts)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _share(self, context: Any, after: Any) -> None:
            self.sampled_law.update(context, self._inputs, after)

    return Impl


Medium = in_double(Medium_)
