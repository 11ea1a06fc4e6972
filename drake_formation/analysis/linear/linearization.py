"""The closed loop about the formation at rest, linearized by Drake from the built diagram.

Everything in :mod:`drake_formation.analysis` starts here; no equation of motion is written a second time. What the
linearization cannot speak of is listed in ``NOT_COVERED``.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydrake.autodiffutils import ExtractGradient, InitializeAutoDiff
from pydrake.systems.framework import Context, Diagram
from pydrake.systems.primitives import Linearize

from drake_formation.analysis.linear.assumptions import (
    require_consensus,
    require_free_masses,
    require_springs,
    require_wires,
)
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.diagram import build_diagram
from drake_formation.formation.formation import Formation
from drake_formation.formation.names import robot_name
from drake_formation.parameters import find_block, has_block, placed_parts
from drake_formation.parts.objects.breaking import BOUNDS, breaks
from drake_formation.parts.part import Part
from drake_formation.scenario import Scenario, resolve, with_overrides
from drake_formation.sources import OWN
from drake_formation.systems.templates import CONVERTING

Array = NDArray[np.float64]

STATES = 4
"""States of a robot: x, y (m) and their rates (m/s), in the world frame."""

NOT_COVERED = (
    "avoidance: every number is for a formation outside the sensing range of all obstacles",
    "large displacements: springs, and consensus on distances, are linearized about the formation at rest; a rotated "
    "formation has other ones",
    "saturation: forces are taken as unlimited",
    "the hand-off: the object is in place",
    "failures and breaks: no robot has failed, and every spring holds",
)
"""What a linearization about the formation at rest says nothing about."""


@dataclass(frozen=True)
class LinearFormation:
    """ẋ = A x + B f about the formation at rest at its goal; x is the deviation, robot after robot.

    The consensus law is linear in its gains, so A is kept in parts: ``A(δ, δ_v) = tracking + springs + δ per_delta +
    δ_v per_delta_v``. All of it is for channels that are wires.

    Attributes:
        scenario: what was linearized: in transport, at its goal, without obstacles, with wires for channels.
        tracking: plants with their local controllers alone, shape (4N, 4N).
        springs: what the object adds, shape (4N, 4N).
        per_delta: what consensus adds for every N/m of δ, shape (4N, 4N).
        per_delta_v: what consensus adds for every N s/m of δ_v, shape (4N, 4N).
        B: accelerations from forces on the robots (N), x and y robot after robot, shape (4N, 2N).
        delta: the scenario's consensus gain δ (N/m).
        delta_v: the scenario's velocity consensus gain δ_v (N s/m).
        channels: the parts that stand in the scenario for the wires, one a channel.
        medium: the part that stands in the scenario for what they share.
    """

    scenario: Scenario
    tracking: Array
    springs: Array
    per_delta: Array
    per_delta_v: Array
    B: Array
    delta: float
    delta_v: float
    channels: tuple[Part, ...]
    medium: Part

    @property
    def resolved(self) -> Formation:
        """The scenario resolved."""
        return resolve(self.scenario)

    @property
    def robots(self) -> int:
        """Number of robots N."""
        return len(self.tracking) // STATES

    @cached_property
    def A(self) -> Array:
        """The closed loop with the scenario's gains, shape (4N, 4N)."""
        return self.closed_loop(self.delta, self.delta_v)

    @cached_property
    def laplacian(self) -> Array:
        """Laplacian of the communication graph, shape (N, N)."""
        laplacian: Array = self.resolved.channels.laplacian
        return laplacian

    def closed_loop(self, delta: float, delta_v: float) -> Array:
        """The closed loop with other consensus gains (N/m, N s/m), shape (4N, 4N)."""
        return self.tracking + self.springs + self.consensus(delta, delta_v)

    def consensus(self, delta: float, delta_v: float) -> Array:
        """What consensus with some gains (N/m, N s/m) adds to A, shape (4N, 4N)."""
        result: Array = delta * self.per_delta + delta_v * self.per_delta_v
        return result


def own(matrix: Array) -> Array:
    """The part of a (4N, 4N) matrix by which every robot acts on itself; the rest is what its neighbours do."""
    robots = len(matrix) // STATES
    result: Array = matrix * np.kron(np.eye(robots), np.ones((STATES, STATES)))
    return result


def linearize(scenario: Scenario) -> LinearFormation:
    """Linearize a scenario's diagram about its formation at rest at the goal.

    Args:
        scenario: what to analyse; its start, phases, reference and obstacles play no part, and its channels are only
            kept.

    Raises:
        ScenarioError: the scenario is wrong.
        IllPosedError: its parts are not those that the analysis is of.
    """
    rest = at_rest(scenario)
    formation = resolve(rest)
    require_springs(formation)
    require_free_masses(formation)
    require_consensus(formation)
    require_wires(formation)
    diagram = build_diagram(rest)
    _require_states(diagram, formation)
    try:
        return _linearized(rest, diagram, resolve(scenario))
    except Exception as error:
        guests = {part.called() for parts in formation.parts.values() for part in parts if part.distribution != OWN}
        if not guests:
            raise
        named = ", ".join(sorted(guests))
        raise IllPosedError(
            f"Drake cannot linearize the diagram with {named}: {type(error).__name__}: {error}"
        ) from error


def _linearized(rest: Scenario, diagram: Diagram, written: Formation) -> LinearFormation:
    formation, context = resolve(rest), diagram.CreateDefaultContext()
    state_matrix = StateMatrix(diagram)
    phase = diagram.GetSubsystemByName("phase").GetMyMutableContextFromRoot(context)

    def with_gains(delta: float, delta_v: float, *, object_in_place: bool = False) -> Array:
        # Past the checks: robots that do not all talk may be linearized, only not made to agree.
        for i in range(formation.robots):
            block = find_block(diagram, f"{robot_name(i)}/consensus").GetMyMutableContextFromRoot(context)
            block.get_mutable_numeric_parameter(0).SetFromVector([delta, delta_v])
        phase.get_mutable_numeric_parameter(0).SetFromVector([float(object_in_place)])
        return state_matrix.at(context)

    gains = formation.parts["coordination"][0].config
    springs = with_gains(0.0, 0.0, object_in_place=True)
    tracking = with_gains(0.0, 0.0)
    return LinearFormation(
        scenario=rest,
        tracking=tracking,
        springs=springs - tracking,
        per_delta=with_gains(1.0, 0.0) - tracking,
        per_delta_v=with_gains(0.0, 1.0) - tracking,
        B=_force_matrix(diagram, rest),
        delta=float(gains.delta),
        delta_v=float(gains.delta_v),
        channels=written.parts["channel"],
        medium=written.parts["medium"][0],
    )


def at_rest(scenario: Scenario) -> Scenario:
    """The scenario as it is linearized: in formation at the goal, in transport, without obstacles, over wires.

    Drake's ``Linearize(diagram, diagram.CreateDefaultContext())`` takes the diagram built from it. It does not take one
    with discrete state, as the hand-off, failures and breaks are: none of these is in it.

    Args:
        scenario: any sound scenario.

    Returns:
        A scenario whose start is an equilibrium.

    Raises:
        ScenarioError: the scenario is wrong.
    """
    changes: dict[str, Any] = {
        "aggregation.duration": 0.0,
        "robots.start": {"centre": list(scenario.transport.goal)},
        "transport.reference": {"kind": "set_point"},
        "avoidance": {"obstacles": []},
        "consensus.channel": {"kind": "ideal"},
    }
    if getattr(scenario.robots, "velocity", None) not in (None, (0.0, 0.0)):
        changes["robots.velocity"] = [0.0, 0.0]
    if resolve(scenario).has_medium:
        changes["consensus.medium"] = {"kind": "none"}
    if scenario.failures:
        changes["failures"] = []
    if breaks(resolve(scenario)):
        names = ["object.grip_strength"] if resolve(scenario).has_body else [f"springs.{name}" for name in BOUNDS]
        changes |= dict.fromkeys(names)
    return with_overrides(scenario, changes)


class StateMatrix:
    """∂ẋ/∂x of a diagram, as Drake's ``Linearize`` gives it; but the diagram is converted once for all Contexts.

    Args:
        diagram: a diagram without input ports, in double.
    """

    def __init__(self, diagram: Diagram) -> None:
        with CONVERTING:
            self._diagram = diagram.ToAutoDiffXd()
        self._context = self._diagram.CreateDefaultContext()

    def at(self, context: Context) -> Array:
        """The matrix about a Context's time, state and parameters, shape (states, states)."""
        self._context.SetTimeStateAndParametersFrom(context)
        state = context.get_continuous_state_vector().CopyToVector()
        self._context.SetContinuousState(InitializeAutoDiff(state).ravel())
        slope = self._diagram.EvalTimeDerivatives(self._context).CopyToVector()
        result: Array = ExtractGradient(slope.reshape(-1, 1))
        return result


def _require_states(diagram: Diagram, formation: Formation) -> None:
    """Refuse parts with states beyond a robot's position and velocity, which no matrix here has rows for."""
    whole, found = diagram.CreateDefaultContext(), []
    for path, part, _ in placed_parts(formation):
        if not has_block(diagram, path):
            continue  # a wire
        own = find_block(diagram, path).GetMyContextFromRoot(whole)
        expected = STATES if part.role == "robot" else 0
        if own.num_continuous_states() != expected or own.num_discrete_state_groups():
            found.append(part.called())
    if found:
        named = ", ".join(dict.fromkeys(found))
        raise IllPosedError(f"{named} has states of its own; what is certified has four a robot")


def _force_matrix(diagram: Diagram, scenario: Scenario) -> Array:
    """Each plant's own force port, block by block: the robots' forces are wired to their controllers."""
    robots = resolve(scenario).robots
    whole = diagram.CreateDefaultContext()
    result = np.zeros((STATES * robots, 2 * robots))
    for i in range(robots):
        plant = find_block(diagram, f"{robot_name(i)}/plant")
        inside = plant.GetMyContextFromRoot(whole)
        alone = plant.CreateDefaultContext()
        for k in range(plant.num_input_ports()):
            port = plant.get_input_port(k)
            port.FixValue(alone, port.Eval(inside))
        force, state = plant.GetInputPort("force").get_index(), plant.GetOutputPort("state").get_index()
        linear = Linearize(plant, alone, force, state)
        result[STATES * i : STATES * (i + 1), 2 * i : 2 * i + 2] = linear.B()
    return result
