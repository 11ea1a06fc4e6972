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

        Input ports: ``sent`` (the state of the robot that speaks, size 4), where asked for ``own`` (that of the one
        that hears), and where channels share a medium ``through`` (what it has carried, size 5). Output ports:
        ``received`` (what the one that hears takes for the state of the other, size 4) and ``traffic`` (packets sent,
        lost, delivered, overtaken and late so far, and when the one in use was sent (s); size 6). Where
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
            shares: bool,
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
                shares: whether a packet is not on its way before a medium has carried it.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (timing, numbers, start, listens, predicts, shares)
            self.kind = listens, predicts, shares, timing  # all else that it computes with is a parameter
            self.sampled_law = CARRY
            self._listens, self._predicts = listens, predicts
            ports = [("sent", 4), *([("own", 4)] * listens), *([("through", 5)] * shares)]
            self._inputs = [self.DeclareVectorInputPort(*port) for port in ports]
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
            self.sampled_law.update(context, self._inputs, after)

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
