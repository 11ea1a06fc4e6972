"""The virtual structure: every robot carries a copy of it, moves the copy, and keeps its own place in it."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.errors import Fault
from drake_formation.config.values import NonNegative, Positive
from drake_formation.formation.formation import Formation
from drake_formation.parts.coordination.local_weights import LocalWeights
from drake_formation.parts.part import Array, Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.lqr import feed_forward_force, lqr_gain, tracking_force
from drake_formation.parts.tracking.none import NoTracking
from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double


def structure_acceleration(
    copy: Sequence[Scalar],
    reference: Sequence[Scalar],
    seen: tuple[Scalar, Scalar],
    heard: Sequence[Sequence[Scalar]],
    gains: Sequence[Scalar],
) -> tuple[Scalar, Scalar]:
    """Acceleration of a robot's copy of the virtual structure, with feedback of the formation's error.

    v̇ = p̈_r − k_G (p − p_r) − d_G (v − v_r) − Σ_j γ_ij (k_S (p − s_j) + d_S (v − v_j)) − k_F E v, with s_j = q_j − h_j
    where robot j takes the structure to be, and the error E = ‖s_i − p‖² + Σ_j γ_ij ‖s_j − p‖² that the robot knows of.

    After Ren and Beard (Decentralized scheme for spacecraft formation flying via the virtual structure approach,
    J. Guidance, Control, and Dynamics 27(1), 2004): goal seeking, synchronisation of the copies, and a damping k_F E
    by which the structure waits for who stays behind. There the goal rests, here v_r and p̈_r let it move; there robots
    tell each other their copies, here they tell their states, of which s_j says where robot j's copy must about be.

    Args:
        copy: [p; v] (m, m/s).
        reference: motion of the formation centre [p_r; v_r; p̈_r] (m, m/s, m/s²).
        seen: s_i, where the robot's own place says that the structure is (m).
        heard: of each robot heard [s_j; v_j; γ_ij] (m, m/s, 1).
        gains: [k_G, d_G, k_S, d_S, k_F] (1/s², 1/s, 1/s², 1/s, 1/(m² s)).

    Returns:
        Components of v̇ (m/s²).
    """
    px, py, vx, vy = copy
    rx, ry, rvx, rvy, rax, ray = reference
    k_goal, d_goal, k_sync, d_sync, k_feedback = gains
    ax, ay = rax - k_goal * (px - rx) - d_goal * (vx - rvx), ray - k_goal * (py - ry) - d_goal * (vy - rvy)
    ex, ey = seen[0] - px, seen[1] - py
    error = ex * ex + ey * ey
    for sx, sy, svx, svy, weight in heard:
        dx, dy = sx - px, sy - py
        ax, ay = ax + weight * (k_sync * dx + d_sync * (svx - vx)), ay + weight * (k_sync * dy + d_sync * (svy - vy))
        error = error + weight * (dx * dx + dy * dy)
    return ax - k_feedback * error * vx, ay - k_feedback * error * vy


@block_template("VirtualStructureController_", __name__)
def VirtualStructureController_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`VirtualStructureController`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A robot's copy of the virtual structure, and the force m v̇ − K (x_i − [p + h_i; v]) that keeps it in there.

        Input ports: ``state`` (size 4), ``reference`` (motion of the formation centre [p; ṗ; p̈], size 6) and, per
        communication neighbour j, ``channel_j`` (the state it sends, size 4). Output ports: ``force`` (N, size 2) and
        ``structure``, the copy (size 4). State: the copy [p; v] (m, m/s). Parameters: 0, its gains, see
        :func:`structure_acceleration`; 1, the gain K row by row (N/m, N s/m); 2, the mass and the slot [m; h_i] (kg,
        m); 3, of each neighbour in port order the slot and the channel's weight [h_j; γ_ij] (m, 1).
        """

        def _construct(
            self,
            neighbours: Sequence[int],
            gains: ArrayLike,
            gain: ArrayLike,
            own: ArrayLike,
            others: ArrayLike,
            start: ArrayLike,
            *,
            converter: Any = None,
        ) -> None:
            """Make the controller.

            Args:
                neighbours: numbers of the robots it hears (from 1), which name the channel ports.
                gains: of the copy, shape (5,).
                gain: K, shape (2, 4).
                own: mass and slot, shape (3,).
                others: slots and weights, shape (neighbours, 3).
                start: default state of the copy, shape (4,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (neighbours, gains, gain, own, others, start)
            self.kind = "virtual structure"  # all that it computes with is a parameter
            self._state = self.DeclareVectorInputPort("state", 4)
            self._reference = self.DeclareVectorInputPort("reference", 6)
            self._channels = [self.DeclareVectorInputPort(f"channel_{j}", 4) for j in neighbours]
            for group in (gains, gain, own, others):
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            self.DeclareContinuousState(BasicVector_[T](start), 2, 2, 0)
            # The time ticket keeps outputs fresh: a rejected step restores the state behind the caches' back.
            fresh = {self.xc_ticket(), self.time_ticket()}
            known = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            self.DeclareVectorOutputPort("force", 2, self._calc_force, fresh | known)
            self.DeclareVectorOutputPort("structure", 4, self._calc_structure, fresh)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _acceleration(
            self, context: Any, copy: list[Scalar], x: Scalar, y: Scalar, hx: Scalar, hy: Scalar
        ) -> tuple[Scalar, Scalar]:
            gains = context.get_numeric_parameter(0).CopyToVector().tolist()
            others = context.get_numeric_parameter(3).CopyToVector().reshape(-1, 3).tolist()
            heard = []
            for port, (ox, oy, weight) in zip(self._channels, others, strict=True):
                nx, ny, nvx, nvy = port.Eval(context).tolist()
                heard.append((nx - ox, ny - oy, nvx, nvy, weight))
            reference = self._reference.Eval(context).tolist()
            return structure_acceleration(copy, reference, (x - hx, y - hy), heard, gains)

        def _calc_force(self, context: Any, output: Any) -> None:
            px, py, pvx, pvy = copy = context.get_continuous_state_vector().CopyToVector().tolist()
            x, y, vx, vy = self._state.Eval(context).tolist()
            gain = context.get_numeric_parameter(1).CopyToVector().tolist()
            mass, hx, hy = context.get_numeric_parameter(2).CopyToVector().tolist()
            fx, fy = tracking_force((x - px - hx, y - py - hy, vx - pvx, vy - pvy), gain)
            ahead_x, ahead_y = feed_forward_force(mass, *self._acceleration(context, copy, x, y, hx, hy))
            output.SetFromVector(np.array([fx + ahead_x, fy + ahead_y]))

        def _calc_structure(self, context: Any, output: Any) -> None:
            output.SetFromVector(context.get_continuous_state_vector().CopyToVector())

        def DoCalcTimeDerivatives(self, context: Any, derivatives: Any) -> None:  # noqa: N802 - Drake's name
            copy = context.get_continuous_state_vector().CopyToVector().tolist()
            x, y, _, _ = self._state.Eval(context).tolist()
            _, hx, hy = context.get_numeric_parameter(2).CopyToVector().tolist()
            derivatives.SetFromVector(np.array([*copy[2:], *self._acceleration(context, copy, x, y, hx, hy)]))

    return Impl


VirtualStructureController = in_double(VirtualStructureController_)


@part("coordination", kind="virtual_structure")
class VirtualStructure(Part):
    """A virtual structure with formation feedback, a copy in every robot (Ren and Beard 2004); tracking is ``none``."""

    class Config(LocalWeights):
        """How the structure moves, and the weights by which robots keep their places in it."""

        k_goal: Positive = Field(
            default=0.025, description="k_G (1/s²), draws the structure to the reference; chosen: as the paper's LQR"
        )
        d_goal: Positive = Field(
            default=0.225, description="d_G (1/s), damps it about the reference; chosen: as the paper's LQR"
        )
        k_sync: NonNegative = Field(default=0.025, description="k_S (1/s²), draws copies together; chosen: as k_G")
        d_sync: NonNegative = Field(default=0.225, description="d_S (1/s), damps copies' differences; chosen: as d_G")
        k_feedback: NonNegative = Field(
            default=1.0, description="k_F (1/(m² s)), slows it by the formation's error; 0 is no feedback; chosen: 1"
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether the weights give a gain."""
        yield from self.config.regulator.checks(formation, owner)

    def warnings(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether the robot is drawn to the reference besides."""
        if not isinstance(formation.parts["tracking"][owner], NoTracking):
            message = "a robot in a virtual structure tracks the reference too"
            yield Fault(("..", "tracking", "kind"), message, allowed="none, as the structure tracks it")

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The structure's gains, the robot's, its mass and slot, and the slots and weights of those heard."""
        config, weights, mass = self.config, self.config.regulator, float(formation.masses[owner])
        gains = np.array([config.k_goal, config.d_goal, config.k_sync, config.d_sync, config.k_feedback])
        gain = lqr_gain(mass, weights.state_cost, weights.input_cost)
        channels = formation.channels
        others = np.column_stack([formation.slots[list(channels.heard[owner])], channels.weights_of(owner)])
        return gains, gain, np.array([mass, *formation.slots[owner]]), others

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The controller."""
        heard = [j + 1 for j in formation.channels.heard[owner]]
        return VirtualStructureController(heard, *numbers, self.initial_state(formation, owner))

    def initial_state(self, formation: Formation, owner: int) -> Array:  # noqa: ARG002
        """The structure begins where the formation gathers, at rest."""
        return np.array([*formation.centre, 0.0, 0.0])
