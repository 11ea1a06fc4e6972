"""The consensus controller of one robot: virtual springs to the robots it talks with (paper, Eqs. 15-17)."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double


def consensus_force(
    dx: Scalar, dy: Scalar, dvx: Scalar, dvy: Scalar, delta: Scalar, delta_v: Scalar, hx: Scalar, hy: Scalar
) -> tuple[Scalar, Scalar]:
    """One term of the consensus control u_g (paper, Eq. 15, with Δ read as [δ I, δ_v I]).

    −(δ (s_i − s_j) + δ_v (v_i − v_j)), with s_i = q_i − h_i.

    Args:
        dx: position of robot i relative to robot j (m), x component of q_i − q_j.
        dy: its y component (m).
        dvx: velocity of robot i relative to robot j (m/s), x component.
        dvy: its y component (m/s).
        delta: consensus gain δ (N/m).
        delta_v: velocity consensus gain δ_v (N s/m).
        hx: desired displacement h_i − h_j (m), x component.
        hy: its y component (m).

    Returns:
        Components of the force on robot i (N).
    """
    return -(delta * (dx - hx) + delta_v * dvx), -(delta * (dy - hy) + delta_v * dvy)


@block_template("ConsensusController_", __name__)
def ConsensusController_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`ConsensusController`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The global control u_g of one robot (paper, Eq. 15).

        Input ports: ``state`` (size 4) and, per communication neighbour j, ``channel_j`` (the state it sends,
        size 4). Output port: ``force`` u_g (N, size 2). Parameters: 0, the gains [δ, δ_v] (N/m, N s/m); 1, for
        each neighbour in port order the desired displacement h_i − h_j (m, two numbers).
        """

        def _construct(
            self, neighbours: Sequence[int], gains: ArrayLike, displacements: ArrayLike, *, converter: Any = None
        ) -> None:
            """Make the controller.

            Args:
                neighbours: numbers of the robots it talks with (from 1), which name the channel ports.
                gains: [δ, δ_v] (N/m, N s/m).
                displacements: desired displacement h_i − h_j of each neighbour (m), shape (neighbours, 2).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (neighbours, gains, displacements)
            self.kind = "consensus"  # all else that it computes with is a parameter
            self._zero = T(0.0)
            self._state = self.DeclareVectorInputPort("state", 4)
            self._channels = [self.DeclareVectorInputPort(f"channel_{j}", 4) for j in neighbours]
            self.DeclareNumericParameter(BasicVector_[T](gains))
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(displacements)))
            self.DeclareVectorOutputPort(
                "force", 2, self._calc_force, {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_force(self, context: Any, output: Any) -> None:
            x, y, vx, vy = self._state.Eval(context).tolist()
            delta, delta_v = context.get_numeric_parameter(0).CopyToVector().tolist()
            displacements = context.get_numeric_parameter(1).CopyToVector().reshape(-1, 2).tolist()
            fx = fy = self._zero
            for port, (hx, hy) in zip(self._channels, displacements, strict=True):
                nx, ny, nvx, nvy = port.Eval(context).tolist()
                gx, gy = consensus_force(x - nx, y - ny, vx - nvx, vy - nvy, delta, delta_v, hx, hy)
                fx, fy = fx + gx, fy + gy  # += would change an Expression in place
            output.SetFromVector(np.array([fx, fy]))

    return Impl


ConsensusController = in_double(ConsensusController_)
