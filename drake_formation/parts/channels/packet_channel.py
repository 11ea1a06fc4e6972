"""A channel that carries packets, as a block."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.parts.channels.packet_law import CARRY
from drake_formation.systems.templates import block_template, in_double


@block_template("PacketChannel_", __name__)
def PacketChannel_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The channel as a template over double, AutoDiffXd and Expression; see :class:`PacketChannel`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Packets from one robot to another, sent and looked for at times.

        Input ports: ``sent`` (the state of the robot that speaks, size 4) and, where asked for, ``own`` (that of the
        one that hears). Output ports: ``received`` (what that takes for the state of the other, size 4) and ``traffic``
        (packets sent, lost, delivered, overtaken and late so far, and when the one in use was sent (s); size 6). Where
        there is ``own``, ``received`` is the place beside it at which nothing is to be corrected whenever the
        neighbour is dropped. Discrete state: what is heard (state, stamp of the sender's clock, 0 where the neighbour
        is dropped), the traffic, what the channel remembers, and the queue. Parameters: 0, the settings; 1, measured
        delays (s); 2, measured losses; 3, outages (s); 4, the desired displacement h_i − h_j (m).
        """

        def _construct(
            self,
            timing: tuple[float, float],
            numbers: tuple[ArrayLike, ...],
            start: tuple[ArrayLike, ...],
            listens: bool,
            predicts: bool,
            *,
            converter: Any = None,
        ) -> None:
            """Make the channel.

            Args:
                timing: how often the receiver looks, and when first (s).
                numbers: the parameters.
                start: the groups of discrete state at the start.
                listens: whether the channel asks for the state of the robot that hears.
                predicts: whether that lets the state heard move on at the speed heard.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (timing, numbers, start, listens, predicts)
            self.kind = listens, predicts, timing  # all else that it computes with is a parameter
            self.sampled_law = CARRY
            self._listens, self._predicts = listens, predicts
            self._inputs = [self.DeclareVectorInputPort(name, 4) for name in ("sent", "own")[: 1 + listens]]
            for group in numbers:
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            heard, traffic, *_ = [self.DeclareDiscreteState(BasicVector_[T](np.ravel(group))) for group in start]
            self.DeclarePeriodicDiscreteUpdateEvent(*timing, self._carry)
            tickets = {self.discrete_state_ticket(heard), self.all_parameters_ticket()}
            if predicts:
                tickets.add(self.time_ticket())
            if listens:
                tickets.add(self._inputs[1].ticket())
            self.DeclareVectorOutputPort("received", 4, self._calc_received, tickets)
            self.DeclareStateOutputPort("traffic", traffic)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _carry(self, context: Any, after: Any) -> None:
            groups = range(context.num_discrete_state_groups())
            state = np.concatenate([context.get_discrete_state(k).CopyToVector() for k in groups])
            numbers = [
                context.get_numeric_parameter(k).CopyToVector() for k in range(context.num_numeric_parameter_groups())
            ]
            inputs = np.concatenate([port.Eval(context) for port in self._inputs])
            self.sampled_law(context.get_time(), inputs, state, np.concatenate(numbers))
            at = 0
            for k in groups:
                group = after.get_mutable_vector(k)
                group.SetFromVector(state[at : at + group.size()])
                at += group.size()

        def _calc_received(self, context: Any, output: Any) -> None:
            x, y, vx, vy, stamp, counts = context.get_discrete_state(0).CopyToVector().tolist()
            if self._predicts:
                age = context.get_time() - stamp
                x, y = x + vx * age, y + vy * age
            heard = [x, y, vx, vy]
            if self._listens:
                own = self._inputs[1].Eval(context).tolist()
                hx, hy = context.get_numeric_parameter(4).CopyToVector().tolist()
                beside = [own[0] - hx, own[1] - hy, *own[2:]]
                heard = [b + counts * (a - b) for a, b in zip(heard, beside, strict=True)]
            output.SetFromVector(np.array(heard))

    return Impl


PacketChannel = in_double(PacketChannel_)
