"""A pure delay of what one robot tells another, as a block: what was sent is kept, and read between what is kept."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double


def between(
    share: Scalar, span: float, here: tuple[Scalar, Scalar], there: tuple[Scalar, Scalar]
) -> tuple[Scalar, Scalar]:
    """Place and velocity between two moments, by the cubic that has the places and velocities at both (Hermite).

    Args:
        share: how far between them, from 0 to 1.
        span: time from one to the other (s).
        here: place (m) and velocity (m/s) at the first.
        there: place and velocity at the second.
    """
    (p, v), (q, w) = here, there
    slope = (q - p) / span
    bend, twist = 3.0 * slope - 2.0 * v - w, v + w - 2.0 * slope
    place = p + share * span * (v + share * (bend + share * twist))
    return place, v + share * (2.0 * bend + 3.0 * share * twist)


@block_template("DelayLine_", __name__)
def DelayLine_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The delay as a template over double, AutoDiffXd and Expression; see :class:`DelayLine`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """y(t) = u(t − τ) of a state [q; v].

        Input port: ``sent`` (m, m/s, size 4). Output port: ``received`` (size 4). Discrete state: 0, the states sent
        at the times t_k − τ … t_k, a constant span apart; 1, the last of these times t_k (s). As τ is a whole number
        of spans, what is read lies between the two oldest of them.
        """

        def _construct(
            self, span: float, offset: float, past: ArrayLike, begin: float, *, converter: Any = None
        ) -> None:
            """Make the delay.

            Args:
                span: between two moments that are kept (s).
                offset: the first of the times t_k (s).
                past: the states kept at the beginning, the oldest first, shape (4 (spans + 1),).
                begin: the beginning (s).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (span, offset, past, begin)
            self.kind = span, offset, np.size(past)  # all else that it computes with is state
            self._span = span
            self._sent = self.DeclareVectorInputPort("sent", 4)
            kept, clock = (self.DeclareDiscreteState(BasicVector_[T](np.ravel(group))) for group in (past, begin))
            self.DeclarePeriodicDiscreteUpdateEvent(span, offset, self._keep)
            tickets = {self.time_ticket(), self.discrete_state_ticket(kept), self.discrete_state_ticket(clock)}
            self.DeclareVectorOutputPort("received", 4, self._calc_received, tickets)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _keep(self, context: Any, after: Any) -> None:
            kept = context.get_discrete_state(0).CopyToVector()
            after.get_mutable_vector(0).SetFromVector(np.concatenate([kept[4:], self._sent.Eval(context)]))
            after.get_mutable_vector(1).SetFromVector(np.array([context.get_time()]))

        def _calc_received(self, context: Any, output: Any) -> None:
            x, y, vx, vy, x1, y1, vx1, vy1 = context.get_discrete_state(0).CopyToVector()[:8].tolist()
            (clock,) = context.get_discrete_state(1).CopyToVector().tolist()
            share = (context.get_time() - clock) / self._span
            (px, pvx), (py, pvy) = (
                between(share, self._span, here, there) for here, there in (((x, vx), (x1, vx1)), ((y, vy), (y1, vy1)))
            )
            output.SetFromVector(np.array([px, py, pvx, pvy]))

    return Impl


DelayLine = in_double(DelayLine_)
