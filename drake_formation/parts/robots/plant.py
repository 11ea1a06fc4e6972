"""The plant of one robot in the plane: what it holds, and by what dynamics it moves (paper, Eqs. 2-3)."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_, NumericParameterIndex

from drake_formation.parts.part import SpringLaw
from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double

Pair = tuple[Scalar, Scalar]
Dynamics = Callable[..., tuple[Scalar, ...]]
"""``dynamics(inner, velocity, control, spring, *numbers)``: how a robot moves.

Of the robot's inner states z (a list), the velocity of the point where it holds the object (m/s), the control force and
what the object exerts there (N), all in the world frame, and the lists of its groups of numbers: the acceleration of
that point (m/s²), x and y, then the rate of each inner state.
"""


@block_template("PlanarRobot_", __name__)
def PlanarRobot_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The plant as a template over double, AutoDiffXd and Expression; see :class:`PlanarRobot`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A robot that holds the object at a point q, with one spring port per physically coupled neighbour.

        Its state is [q; v; z]: position and velocity of that point in the world frame (m, m/s), and the inner states
        of its dynamics, such as a heading. Input ports: ``force`` (N, size 2), ``phase`` (0 aggregation, 1 transport:
        the springs are engaged), per neighbour j ``spring_j`` (the neighbour's state, size 4), and where the object is
        a body of its own ``load``, what that exerts (N, size 2). Where springs may break or be let go, ``intact`` and
        ``held`` have for each neighbour 1 while its spring acts, else 0; where the robot may fail, ``failure`` has the
        share of the control force that its drives give, 0 while its brakes take up all forces and else 1, and 1/τ
        (1/s) of v̇ = −v/τ while they do, else 0. Output ports: ``state`` x = [q; v], ``spring_force``
        −Σ F_ij and the load (N), unless it is the sum of the forces by the mass ``acceleration`` v̇ (m/s²), and where
        the first inner state is one ``heading`` (rad). Parameters: the groups of the dynamics; last, for each neighbour
        in port order the numbers of the spring law and the desired displacement h_i − h_j (m, two numbers).
        """

        def _construct(
            self,
            dynamics: Dynamics,
            neighbours: Sequence[int],
            law: type[SpringLaw],
            numbers: Sequence[ArrayLike],
            springs: ArrayLike,
            initial_state: ArrayLike,
            *,
            acceleration: bool = True,
            load: bool = False,
            releases: Sequence[str] = (),
            may_fail: bool = False,
            heading: bool = False,
            converter: Any = None,
        ) -> None:
            """Make the plant.

            Args:
                dynamics: see :data:`Dynamics`; the same function for all robots that one kind of code may serve.
                neighbours: numbers of the physically coupled robots (from 1), which name the spring ports.
                law: how a spring acts.
                numbers: what the dynamics compute with, by group.
                springs: numbers of the law and displacement of each spring, shape (neighbours, numbers + 2).
                initial_state: default state [q; v; z], shape (4 + inner states,).
                acceleration: whether to have that output port.
                load: whether to have that input port.
                releases: which of the input ports ``intact`` and ``held`` to have.
                may_fail: whether to have the input port ``failure``.
                heading: whether to have that output port: the first inner state.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (dynamics, neighbours, law, numbers, springs, initial_state)
            self.options = {
                "acceleration": acceleration,
                "load": load,
                "releases": releases,
                "may_fail": may_fail,
                "heading": heading,
            }
            # All else that it computes with is a parameter.
            self.kind = dynamics, law, load, tuple(releases), may_fail
            self._dynamics, self._law = dynamics, law.law
            self._groups, self._columns = range(len(numbers)), len(law.arguments()) + 2
            self._zero = T(0.0)
            self._force = self.DeclareVectorInputPort("force", 2)
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self._springs = [self.DeclareVectorInputPort(f"spring_{j}", 4) for j in neighbours]
            self._load = self.DeclareVectorInputPort("load", 2) if load else None
            self._releases = [self.DeclareVectorInputPort(name, len(neighbours)) for name in releases]
            self._failure = self.DeclareVectorInputPort("failure", 3) if may_fail else None
            for group in (*numbers, springs):
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            self.DeclareContinuousState(BasicVector_[T](initial_state), 2, 2, np.size(initial_state) - 4)
            # The time ticket keeps the output fresh: after a rejected step Drake restores the state without
            # telling the caches, but it always tells them the time.
            fresh_state = {self.xc_ticket(), self.time_ticket()}
            self.DeclareVectorOutputPort("state", 4, self._calc_state, fresh_state)
            held = [self._phase, *self._springs, *self._releases, *([self._load] if self._load else [])]
            coupled_ports = {self.input_port_ticket(port.get_index()) for port in held}
            self.DeclareVectorOutputPort(
                "spring_force",
                2,
                self._calc_spring_force,
                fresh_state | coupled_ports | {self.numeric_parameter_ticket(NumericParameterIndex(len(numbers)))},
            )
            if acceleration:
                all_read = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
                self.DeclareVectorOutputPort("acceleration", 2, self._calc_acceleration, fresh_state | all_read)
            if heading:
                self.DeclareVectorOutputPort("heading", 1, self._calc_heading, fresh_state)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, **other.options, converter=converter)

        def _calc_state(self, context: Any, output: Any) -> None:
            output.SetFromVector(context.get_continuous_state_vector().CopyToVector()[:4])

        def _calc_spring_force(self, context: Any, output: Any) -> None:
            state = context.get_continuous_state_vector().CopyToVector().tolist()
            output.SetFromVector(np.array(self._spring_force(context, *state[:4])))

        def _calc_acceleration(self, context: Any, output: Any) -> None:
            state = context.get_continuous_state_vector().CopyToVector().tolist()
            output.SetFromVector(np.array(self._rates(context, state)[:2]))

        def _calc_heading(self, context: Any, output: Any) -> None:
            output.SetFromVector(context.get_continuous_state_vector().CopyToVector()[4:5])

        def _spring_force(self, context: Any, x: Scalar, y: Scalar, vx: Scalar, vy: Scalar) -> Pair:
            (phase,) = self._phase.Eval(context).tolist()
            table = context.get_numeric_parameter(len(self._groups)).CopyToVector()
            springs = table.reshape(-1, self._columns).tolist()
            fx = fy = self._zero
            law = self._law
            released = [port.Eval(context).tolist() for port in self._releases]
            for k, (port, numbers) in enumerate(zip(self._springs, springs, strict=True)):
                nx, ny, nvx, nvy = port.Eval(context).tolist()
                gx, gy = law(x - nx, y - ny, vx - nvx, vy - nvy, *numbers)
                for acts in released:
                    gx, gy = acts[k] * gx, acts[k] * gy
                fx, fy = fx - gx, fy - gy  # -= would change an Expression in place
            if self._load is None:
                return phase * fx, phase * fy
            lx, ly = self._load.Eval(context).tolist()
            return phase * fx + lx, phase * fy + ly

        def _rates(self, context: Any, state: list[Scalar]) -> tuple[Scalar, ...]:
            """Of velocity and inner states."""
            control = self._force.Eval(context).tolist()
            spring = self._spring_force(context, *state[:4])
            numbers = [context.get_numeric_parameter(k).CopyToVector().tolist() for k in self._groups]
            if self._failure is None:
                return self._dynamics(state[4:], state[2:4], control, spring, *numbers)
            drive, free, braking = self._failure.Eval(context).tolist()
            driven = [drive * u for u in control]
            ax, ay, *inner = self._dynamics(state[4:], state[2:4], driven, spring, *numbers)
            return free * ax - braking * state[2], free * ay - braking * state[3], *inner

        def DoCalcTimeDerivatives(self, context: Any, derivatives: Any) -> None:  # noqa: N802 - Drake's name
            state = context.get_continuous_state_vector().CopyToVector().tolist()
            derivatives.SetFromVector(np.array([*state[2:4], *self._rates(context, state)]))

    return Impl


PlanarRobot = in_double(PlanarRobot_)
