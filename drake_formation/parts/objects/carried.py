"""A carried object that is a body of its own: its block, whatever its mechanics, and what all such parts share."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.formation.formation import Formation
from drake_formation.parts.objects.breaking import breaks
from drake_formation.parts.objects.grips import GripNumbers, Motion, Pair, grip_force
from drake_formation.parts.part import Array, Numbers, Part
from drake_formation.systems.templates import block_template, in_double

STATE, POSE = 4, 6


class Mechanics(ABC):
    """How an object moves; equal ones do so by the same law, and all else are numbers.

    The state is [q; v], coordinates and their rates, an array of any scalar; ``numbers`` are arrays, one a group.
    """

    @abstractmethod
    def points(self, state: Any, robots: Sequence[int], numbers: Sequence[Any]) -> Sequence[Motion]:
        """Where some robots, from 0, hold the object, and how fast these points move (m, m/s)."""

    @abstractmethod
    def accelerations(self, state: Any, forces: Sequence[Pair], numbers: Sequence[Any]) -> Any:
        """v̇ (m/s², rad/s²), an array, under what the robots exert at their grips in the world frame (N)."""

    @abstractmethod
    def pose(self, state: Any, numbers: Sequence[Any]) -> Sequence[Any]:
        """Place of the centre of mass, heading, and their rates (m, rad, m/s, rad/s)."""

    def nodes(self, state: Any) -> Any:
        """Places of the nodes of a grid, row by row, x and y of each (m); none by default."""
        return state[:0]

    @abstractmethod
    def strain(self, state: Any, stretches: Sequence[Pair], numbers: Sequence[Any]) -> Any:
        """How far it is strained (1), as its kind says; stretches are how far robots are off their points (m)."""


@block_template("CarriedBody_", __name__)
def CarriedBody_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The object as a template over double, AutoDiffXd and Expression; see :class:`CarriedBody`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """An object that rests until the hand-off, and then is carried by all robots, each by its grip.

        Its state is that of its mechanics. Input ports: for every robot j ``state_j`` (m, m/s, size 4), and ``phase``
        (0 aggregation, 1 transport); where grips may break or be let go, ``intact`` and ``held`` have for every robot 1
        while its grip acts, else 0. Output ports: for every robot ``grip_force_j``, what the object exerts on it (N,
        size 2, zero during aggregation), ``pose`` (size 6), ``strain`` (size 1) and, if its mechanics have any,
        ``nodes`` (m). Parameters: 0, stiffness and damping of a grip (N/m, N s/m); then the mechanics' groups.
        """

        def _construct(
            self,
            mechanics: Mechanics,
            robots: int,
            numbers: Sequence[ArrayLike],
            initial_state: ArrayLike,
            *,
            releases: Sequence[str] = (),
            converter: Any = None,
        ) -> None:
            """Make the object.

            Args:
                mechanics: how it moves.
                robots: how many hold it.
                numbers: of the grips, then what the mechanics compute with, by group.
                initial_state: default state [q; v].
                releases: which of the input ports ``intact`` and ``held`` to have.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (mechanics, robots, numbers, initial_state)
            self.releases = tuple(releases)
            self.kind = mechanics, self.releases  # all else that it computes with is a parameter
            self._mechanics, self._robots = mechanics, range(robots)
            self._groups, self._half = range(1, len(numbers)), np.size(initial_state) // 2
            self._states = [self.DeclareVectorInputPort(f"state_{j + 1}", STATE) for j in self._robots]
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self._releases = [self.DeclareVectorInputPort(name, robots) for name in releases]
            for group in numbers:
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            self.DeclareContinuousState(BasicVector_[T](initial_state), self._half, self._half, 0)
            # The time ticket keeps the output fresh, as in the robots' plants.
            own = {self.xc_ticket(), self.time_ticket(), self.all_parameters_ticket()}
            for j, state in enumerate(self._states):
                ports = (state, self._phase, *self._releases)
                read = {self.input_port_ticket(port.get_index()) for port in ports}
                self.DeclareVectorOutputPort(f"grip_force_{j + 1}", 2, self._calc_grip_force(j), own | read)
            self.DeclareVectorOutputPort("pose", POSE, self._calc_pose, own)
            read = {self.input_port_ticket(port.get_index()) for port in (*self._states, *self._releases)}
            self.DeclareVectorOutputPort("strain", 1, self._calc_strain, own | read)
            if nodes := len(mechanics.nodes(np.asarray(initial_state))):
                self.DeclareVectorOutputPort("nodes", nodes, self._calc_nodes, own)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, releases=other.releases, converter=converter)

        def _read(self, context: Any) -> tuple[Any, list[Any]]:
            """The state and the mechanics' numbers."""
            state = context.get_continuous_state_vector().CopyToVector()
            return state, [context.get_numeric_parameter(k).CopyToVector() for k in self._groups]

        def _forces(self, context: Any, state: Any, robots: Sequence[int], numbers: list[Any]) -> list[Pair]:
            """What the object exerts on some robots once it is carried (N)."""
            stiffness, damping = context.get_numeric_parameter(0).CopyToVector().tolist()
            points = self._mechanics.points(state, robots, numbers)
            forces = [
                grip_force(self._states[j].Eval(context).tolist(), point, stiffness, damping)
                for j, point in zip(robots, points, strict=True)
            ]
            return self._acting(context, robots, forces)

        def _acting(self, context: Any, robots: Sequence[int], pairs: list[Pair]) -> list[Pair]:
            """Forces or stretches of the grips that act, and nothing of the others."""
            for port in self._releases:
                acts = port.Eval(context).tolist()
                pairs = [(acts[j] * x, acts[j] * y) for j, (x, y) in zip(robots, pairs, strict=True)]
            return pairs

        def _calc_grip_force(self, robot: int) -> Any:
            def calc(context: Any, output: Any) -> None:
                state, numbers = self._read(context)
                (phase,) = self._phase.Eval(context).tolist()
                ((fx, fy),) = self._forces(context, state, (robot,), numbers)
                output.SetFromVector(np.array([phase * fx, phase * fy]))

            return calc

        def _calc_pose(self, context: Any, output: Any) -> None:
            state, numbers = self._read(context)
            output.SetFromVector(np.array(self._mechanics.pose(state, numbers)))

        def _calc_strain(self, context: Any, output: Any) -> None:
            state, numbers = self._read(context)
            points = self._mechanics.points(state, self._robots, numbers)
            places = [port.Eval(context).tolist() for port in self._states]
            stretches = [(q[0] - p[0], q[1] - p[1]) for q, p in zip(places, points, strict=True)]
            acting = self._acting(context, self._robots, stretches)
            output.SetFromVector(np.array([self._mechanics.strain(state, acting, numbers)]))

        def _calc_nodes(self, context: Any, output: Any) -> None:
            state, _ = self._read(context)
            output.SetFromVector(self._mechanics.nodes(state))

        def DoCalcTimeDerivatives(self, context: Any, derivatives: Any) -> None:  # noqa: N802 - Drake's name
            state, numbers = self._read(context)
            (phase,) = self._phase.Eval(context).tolist()
            forces = [(-fx, -fy) for fx, fy in self._forces(context, state, self._robots, numbers)]
            rates = self._mechanics.accelerations(state, forces, numbers).tolist()
            derivatives.SetFromVector(np.concatenate([state[self._half :], [phase * rate for rate in rates]]))

    return Impl


CarriedBody = in_double(CarriedBody_)


class CarriedObject(Part, ABC):
    """An object that is a body of its own; its kinds say by what mechanics it moves."""

    Config = GripNumbers

    @abstractmethod
    def mechanics(self, formation: Formation) -> Mechanics:
        """How it moves."""

    @abstractmethod
    def own_numbers(self, formation: Formation) -> Numbers:
        """What its mechanics compute with, by group."""

    @abstractmethod
    def initial_state(self, formation: Formation, owner: int) -> Array:
        """At rest, unstrained and with heading 0, where the formation gathers."""

    @abstractmethod
    def fastest(self, formation: Formation) -> tuple[float, float]:
        """Bounds on stiffness and damping of its fastest mode by the mass that moves in it (1/s², 1/s)."""

    def layout(self, formation: Formation, owner: int) -> Mechanics:  # noqa: ARG002
        """Its mechanics, which may know which part of the object each robot holds."""
        return self.mechanics(formation)

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """Those of the grips, then its own."""
        return np.array([self.config.grip_stiffness, self.config.grip_damping]), *self.own_numbers(formation)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The object."""
        start = self.initial_state(formation, owner)
        let_go = {"intact": breaks(formation), "held": "held" in formation.signals}
        releases = tuple(name for name, may in let_go.items() if may)
        return CarriedBody(self.mechanics(formation), formation.robots, numbers, start, releases=releases)
