"""The plant of one robot: a mass in the plane, held to its neighbours by the carried object (paper, Eqs. 2-7)."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_, NumericParameterIndex

from drake_formation.config.values import Positive, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Array, Numbers, Part, SpringLaw
from drake_formation.parts.registry import part
from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double


@block_template("RobotPlant_", __name__)
def RobotPlant_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The plant as a template over double, AutoDiffXd and Expression; see :class:`RobotPlant`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A mass in the plane with one spring port per physically coupled neighbour (paper, Eqs. 2-3).

        Input ports: ``force`` (N, size 2), ``phase`` (0 aggregation, 1 transport: the springs are engaged) and, per
        neighbour j, ``spring_j`` (the neighbour's state, size 4). Output ports: ``state`` x = [q; v] (m, m/s) and
        ``spring_force`` −Σ F_ij (N). Parameters: 0, the mass (kg); 1, for each neighbour in port order the
        numbers of the spring law and the desired displacement h_i − h_j (m, two numbers).
        """

        def _construct(
            self,
            neighbours: Sequence[int],
            law: type[SpringLaw],
            mass: ArrayLike,
            springs: ArrayLike,
            initial_state: ArrayLike,
            *,
            converter: Any = None,
        ) -> None:
            """Make the plant.

            Args:
                neighbours: numbers of the physically coupled robots (from 1), which name the spring ports.
                law: how a spring acts.
                mass: m_i (kg), shape (1,).
                springs: numbers of the law and displacement of each spring, shape (neighbours, numbers + 2).
                initial_state: default state [q; v], shape (4,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (neighbours, law, mass, springs, initial_state)
            self.kind = law  # all else that it computes with is a parameter
            self._law = law.law
            self._columns = len(law.Config.model_fields) + 2
            self._zero = T(0.0)
            self._force = self.DeclareVectorInputPort("force", 2)
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self._springs = [self.DeclareVectorInputPort(f"spring_{j}", 4) for j in neighbours]
            self.DeclareNumericParameter(BasicVector_[T](mass))
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(springs)))
            self.DeclareContinuousState(BasicVector_[T](initial_state), 2, 2, 0)
            # The time ticket keeps the output fresh: after a rejected step Drake restores the state without
            # telling the caches, but it always tells them the time.
            fresh_state = {self.xc_ticket(), self.time_ticket()}
            self.DeclareVectorOutputPort("state", 4, self._calc_state, fresh_state)
            coupled_ports = {self.input_port_ticket(port.get_index()) for port in [self._phase, *self._springs]}
            self.DeclareVectorOutputPort(
                "spring_force",
                2,
                self._calc_spring_force,
                fresh_state | coupled_ports | {self.numeric_parameter_ticket(NumericParameterIndex(1))},
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_state(self, context: Any, output: Any) -> None:
            output.SetFromVector(context.get_continuous_state_vector().CopyToVector())

        def _calc_spring_force(self, context: Any, output: Any) -> None:
            state = context.get_continuous_state_vector().CopyToVector().tolist()
            output.SetFromVector(np.array(self._spring_force(context, *state)))

        def _spring_force(self, context: Any, x: Scalar, y: Scalar, vx: Scalar, vy: Scalar) -> tuple[Scalar, Scalar]:
            (phase,) = self._phase.Eval(context).tolist()
            springs = context.get_numeric_parameter(1).CopyToVector().reshape(-1, self._columns).tolist()
            fx = fy = self._zero
            law = self._law
            for port, numbers in zip(self._springs, springs, strict=True):
                nx, ny, nvx, nvy = port.Eval(context).tolist()
                gx, gy = law(x - nx, y - ny, vx - nvx, vy - nvy, *numbers)
                fx, fy = fx - gx, fy - gy  # -= would change an Expression in place
            return phase * fx, phase * fy

        def DoCalcTimeDerivatives(self, context: Any, derivatives: Any) -> None:  # noqa: N802 - Drake's name
            x, y, vx, vy = context.get_continuous_state_vector().CopyToVector().tolist()
            ux, uy = self._force.Eval(context).tolist()
            sx, sy = self._spring_force(context, x, y, vx, vy)
            (mass,) = context.get_numeric_parameter(0).CopyToVector().tolist()
            derivatives.SetFromVector(np.array([vx, vy, (ux + sx) / mass, (uy + sy) / mass]))

    return Impl


RobotPlant = in_double(RobotPlant_)


@part("robot", kind="point_mass")
class PointMass(Part):
    """A point mass, pushed in any direction (paper, Eq. 3)."""

    class Config(Section):
        """Its mass."""

        mass: Positive = Field(default=40.0, description="mass m_i (kg), one for all or one a robot; published: 40")

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The mass, and of each spring the law's numbers and the desired displacement."""
        return np.array([self.config.mass]), spring_table(formation, owner)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The plant."""
        held = [j + 1 for j in formation.springs.neighbours[owner]]
        start = self.initial_state(formation, owner)
        return RobotPlant(held, formation.law, *numbers, start)

    def initial_state(self, formation: Formation, owner: int) -> Array:
        """At its starting position, at rest."""
        return np.concatenate([formation.starts[owner], np.zeros(2)])


def spring_table(formation: Formation, robot: int) -> Array:
    """Of each spring of a robot in port order, the numbers of the law and h_i − h_j, shape (neighbours, columns)."""
    others = formation.springs.neighbours[robot]
    rows = [formation.parts["spring"][edge].numbers(formation, edge)[0] for edge in formation.springs.incident(robot)]
    numbers = np.array(rows, dtype=float).reshape(len(others), len(formation.law.Config.model_fields))
    return np.column_stack([numbers, formation.displacements(robot, others)])
