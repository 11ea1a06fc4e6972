"""The consensus controller of one robot: virtual springs to the robots it talks with (paper, Eqs. 15-17)."""

from collections.abc import Callable, Hashable, Iterator, Sequence
from typing import Any, Literal

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.errors import Fault, shortened, shown
from drake_formation.config.values import NonNegative, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.coordination.distances import distance_force, flexible
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
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


ConsensusLaw = Callable[..., tuple[Scalar, Scalar]]
"""What one robot draws another with; arguments and result as in :func:`consensus_force`."""

LAWS: dict[str, ConsensusLaw] = {"linear": consensus_force, "hookean": distance_force}
"""By their names in scenarios."""


@block_template("ConsensusController_", __name__)
def ConsensusController_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`ConsensusController`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The global control u_g of one robot (paper, Eq. 15), by a law for each pair of robots.

        Input ports: ``state`` (size 4) and, per communication neighbour j, ``channel_j`` (the state it sends,
        size 4). Output port: ``force`` u_g (N, size 2). Parameters: 0, the gains [δ, δ_v] (N/m, N s/m); 1, for
        each neighbour in port order the desired displacement h_i − h_j (m, two numbers); and where channels have
        weights 2, the weight γ_ij of each.
        """

        def _construct(
            self,
            neighbours: Sequence[int],
            gains: ArrayLike,
            displacements: ArrayLike,
            weights: ArrayLike | None = None,
            law: ConsensusLaw = consensus_force,
            *,
            converter: Any = None,
        ) -> None:
            """Make the controller.

            Args:
                neighbours: numbers of the robots it talks with (from 1), which name the channel ports.
                gains: [δ, δ_v] (N/m, N s/m).
                displacements: desired displacement h_i − h_j of each neighbour (m), shape (neighbours, 2).
                weights: γ_ij of each neighbour, shape (neighbours,); None where all are 1, as in the paper's cases.
                law: how the robots of a pair draw each other.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (neighbours, gains, displacements, weights, law)
            self.kind = weights is None, law  # all else that it computes with is a parameter
            self._law = law
            self._zero = T(0.0)
            self._state = self.DeclareVectorInputPort("state", 4)
            self._channels = [self.DeclareVectorInputPort(f"channel_{j}", 4) for j in neighbours]
            self.DeclareNumericParameter(BasicVector_[T](gains))
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(displacements)))
            self._weighted = weights is not None
            if self._weighted:
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(np.asarray(weights, dtype=float))))
            self.DeclareVectorOutputPort(
                "force", 2, self._calc_force, {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_force(self, context: Any, output: Any) -> None:
            x, y, vx, vy = self._state.Eval(context).tolist()
            delta, delta_v = context.get_numeric_parameter(0).CopyToVector().tolist()
            displacements = context.get_numeric_parameter(1).CopyToVector().reshape(-1, 2).tolist()
            weights = context.get_numeric_parameter(2).CopyToVector().tolist() if self._weighted else None
            fx = fy = self._zero
            law = self._law
            for k, (port, (hx, hy)) in enumerate(zip(self._channels, displacements, strict=True)):
                nx, ny, nvx, nvy = port.Eval(context).tolist()
                gx, gy = law(x - nx, y - ny, vx - nvx, vy - nvy, delta, delta_v, hx, hy)
                if weights is not None:
                    gx, gy = weights[k] * gx, weights[k] * gy
                fx, fy = fx + gx, fy + gy  # += would change an Expression in place
            output.SetFromVector(np.array([fx, fy]))

    return Impl


ConsensusController = in_double(ConsensusController_)


@part("coordination", kind="consensus")
class Consensus(Part):
    """Virtual springs over the communication graph, on displacements (paper, Eqs. 15-17) or on distances."""

    class Config(Section):
        """The gains of the virtual springs, and how they act."""

        law: Literal["linear", "hookean"] = Field(
            default="linear",
            description="how robots draw each other: linear on displacements (Eq. 15), or hookean on distances, along "
            "the lines between them, which leaves the formation free to turn; paper: linear",
        )
        delta: NonNegative = Field(default=0.0, description="consensus gain δ (N/m); published: 0, 1e4, 2e4")
        delta_v: NonNegative = Field(default=0.0, description="velocity consensus gain δ_v (N s/m); paper: 0")

    @property
    def law(self) -> ConsensusLaw:
        """How the robots of a pair draw each other."""
        return LAWS[self.config.law]

    @property
    def _idle(self) -> bool:
        return bool(self.config.delta == 0 and self.config.delta_v == 0)

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether the channels can bring all robots to agree (paper, Lemma 1)."""
        channels = formation.channels
        if self._idle or channels.agree:
            return
        if channels.undirected:
            groups = [sorted(group) for group in nx.connected_components(channels.graph)]
            named = " and ".join("{" + ", ".join(str(robot + 1) for robot in group) + "}" for group in groups)
            message = f"no channel between robots {shortened(named)}, so they reach no consensus (Lemma 1)"
            allowed = "a connected graph while delta or delta_v is above 0"
            value = shown([[i + 1, j + 1] for i, j in sorted(channels.graph.edges)])
        else:
            message = "no robot is heard, over others, by all, so they reach no consensus (Lemma 1)"
            allowed = "channels with a spanning tree from one robot to all while delta or delta_v is above 0"
            value = ""
        yield Fault(("graph",), message, value, allowed)

    def warnings(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether distances over the channels hold the shape, where they are all that is held."""
        if not self._idle and self.config.law == "hookean":
            yield from flexible(formation)

    def structure(self) -> Hashable:
        """The law, which no parameter holds."""
        return str(self.config.law)

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The gains, the desired displacements, and the channels' weights where there are any."""
        channels = formation.channels
        gains = np.array([self.config.delta, self.config.delta_v])
        displacements = formation.displacements(owner, channels.heard[owner])
        weights = (channels.weights_of(owner),) if channels.weighted else ()
        return gains, displacements, *weights

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The controller."""
        return ConsensusController([j + 1 for j in formation.channels.heard[owner]], *numbers, law=self.law)
