"""A scenario as a Drake diagram: the only place that wires blocks (paper, Figs. 2 and 3)."""

import numpy as np
from pydrake.systems.framework import Diagram, DiagramBuilder, System
from pydrake.systems.primitives import Adder, ConstantVectorSource

from drake_formation.formation import graphs
from drake_formation.parameters import Parameters, block_parameters, robot_name
from drake_formation.references.set_point import SetPoint
from drake_formation.references.trajectory import TrajectoryReference
from drake_formation.scenario import Scenario, derive, require_sound
from drake_formation.systems.avoidance import ObstacleAvoidance
from drake_formation.systems.consensus import ConsensusController
from drake_formation.systems.consensus_error import ConsensusError
from drake_formation.systems.hand_off import HandOff
from drake_formation.systems.plant import RobotPlant
from drake_formation.systems.sensing import NearestSensing
from drake_formation.systems.tracking import TrackingController

ROBOT_OUTPUTS = (
    "state",
    "tracking_error",
    "tracking_force",
    "consensus_force",
    "avoidance_force",
    "control_force",
    "spring_force",
)
"""Output ports of every robot."""


def build_diagram(scenario: Scenario) -> Diagram:
    """Build the block diagram of a scenario.

    Its default Context is the scenario's initial state, at rest. The hand-off is an event of the diagram that changes
    discrete state, which Drake's ``Linearize`` does not take: at ``aggregation.duration`` 0 there is none, and
    :func:`drake_formation.analysis.at_rest` gives a scenario that starts where its diagram can be linearized. Output
    ports, for every robot i from 1: ``robot_i_state`` (m, m/s), ``robot_i_tracking_error`` x − x_r (m, m/s),
    ``robot_i_consensus_error`` (m), and in newtons ``robot_i_tracking_force`` u_l, ``robot_i_consensus_force`` u_g,
    ``robot_i_avoidance_force``, ``robot_i_control_force`` (the sum of the three) and ``robot_i_spring_force``; and
    ``phase`` (0 aggregation, 1 transport).

    Args:
        scenario: what to build.

    Returns:
        The diagram, in double; it converts to AutoDiffXd and Expression.

    Raises:
        ScenarioError: the scenario is wrong.
    """
    require_sound(scenario)
    parameters = block_parameters(scenario)
    builder = DiagramBuilder()
    phase = builder.AddNamedSystem("phase", _phase(scenario))
    reference = builder.AddNamedSystem("reference", _reference(scenario, parameters))
    if reference.num_input_ports():
        builder.Connect(phase.get_output_port(), reference.GetInputPort("phase"))
    robots = [
        builder.AddNamedSystem(robot_name(i), build_robot(scenario, parameters, i))
        for i in range(derive.robot_count(scenario.formation))
    ]
    for robot in robots:
        builder.Connect(phase.get_output_port(), robot.GetInputPort("phase"))
        builder.Connect(reference.get_output_port(), robot.GetInputPort("reference"))
    _couple(builder, robots, scenario)
    if scenario.avoidance.sensing == "nearest":
        _sense_nearest(builder, robots, parameters)
    for i, robot in enumerate(robots):
        for output in ROBOT_OUTPUTS:
            builder.ExportOutput(robot.GetOutputPort(output), f"{robot_name(i)}_{output}")
    _observe_consensus(builder, robots, parameters)
    builder.ExportOutput(phase.get_output_port(), "phase")
    diagram = builder.Build()
    diagram.set_name(scenario.name)
    return diagram


def build_robot(scenario: Scenario, parameters: Parameters, robot: int) -> Diagram:
    """Build one robot: its plant and its three controllers (paper, Fig. 3).

    Args:
        scenario: a sound scenario.
        parameters: the numbers of its blocks.
        robot: index of the robot, from 0.

    Returns:
        The robot, with input ports ``phase``, ``reference``, ``spring_j``, ``channel_j`` (and ``sensed``) and the
        output ports named in ``ROBOT_OUTPUTS``.
    """
    name = robot_name(robot)
    held = [j + 1 for j in graphs.neighbours(derive.spring_graph(scenario), robot)]
    heard = [j + 1 for j in graphs.neighbours(derive.communication_graph(scenario), robot)]
    start = np.concatenate([derive.starts(scenario)[robot], np.zeros(2)])
    masked = scenario.avoidance.sensing == "nearest"

    builder = DiagramBuilder()
    plant = builder.AddNamedSystem("plant", RobotPlant(held, scenario.springs.law, *parameters[f"{name}/plant"], start))
    tracking = builder.AddNamedSystem("tracking", TrackingController(*parameters[f"{name}/tracking"]))
    consensus = builder.AddNamedSystem("consensus", ConsensusController(heard, *parameters[f"{name}/consensus"]))
    avoidance = builder.AddNamedSystem("avoidance", ObstacleAvoidance(*parameters[f"{name}/avoidance"], masked))
    control = builder.AddNamedSystem("control", Adder(3, 2))

    for k, controller in enumerate((tracking, consensus, avoidance)):
        builder.Connect(plant.GetOutputPort("state"), controller.GetInputPort("state"))
        builder.Connect(controller.GetOutputPort("force"), control.get_input_port(k))
        builder.ExportOutput(controller.GetOutputPort("force"), f"{controller.get_name()}_force")
    builder.Connect(control.get_output_port(), plant.GetInputPort("force"))

    builder.ExportInput(plant.GetInputPort("phase"), "phase")
    builder.ConnectInput("phase", avoidance.GetInputPort("phase"))
    builder.ExportInput(tracking.GetInputPort("reference"), "reference")
    for j in held:
        builder.ExportInput(plant.GetInputPort(f"spring_{j}"), f"spring_{j}")
    for j in heard:
        builder.ExportInput(consensus.GetInputPort(f"channel_{j}"), f"channel_{j}")
    if masked:
        builder.ExportInput(avoidance.GetInputPort("sensed"), "sensed")
    builder.ExportOutput(plant.GetOutputPort("state"), "state")
    builder.ExportOutput(plant.GetOutputPort("spring_force"), "spring_force")
    builder.ExportOutput(tracking.GetOutputPort("error"), "tracking_error")
    builder.ExportOutput(control.get_output_port(), "control_force")
    return builder.Build()


def _phase(scenario: Scenario) -> System:
    """The hand-off, or a constant where the scenario starts at transport."""
    if scenario.aggregation.duration == 0:
        return ConstantVectorSource([1.0])
    return HandOff(derive.hand_off_time(scenario))


def _reference(scenario: Scenario, parameters: Parameters) -> System:
    """A set point, which switches with the phase, or a trajectory, which starts by the clock at the hand-off."""
    if scenario.transport.reference.kind == "set_point":
        return SetPoint(*parameters["reference"])
    return TrajectoryReference(*parameters["reference"])


def _couple(builder: DiagramBuilder, robots: list[Diagram], scenario: Scenario) -> None:
    """Wire the spring ports by the physical graph and the channels by the communication graph."""
    for kind, graph in (("spring", derive.spring_graph(scenario)), ("channel", derive.communication_graph(scenario))):
        for i, j in graphs.edges(graph):
            builder.Connect(robots[j].GetOutputPort("state"), robots[i].GetInputPort(f"{kind}_{j + 1}"))
            builder.Connect(robots[i].GetOutputPort("state"), robots[j].GetInputPort(f"{kind}_{i + 1}"))


def _sense_nearest(builder: DiagramBuilder, robots: list[Diagram], parameters: Parameters) -> None:
    (centres,) = parameters["sensing"]
    sensing = builder.AddNamedSystem("sensing", NearestSensing(len(robots), centres))
    for i, robot in enumerate(robots):
        builder.Connect(robot.GetOutputPort("state"), sensing.get_input_port(i))
        builder.Connect(sensing.get_output_port(i), robot.GetInputPort("sensed"))


def _observe_consensus(builder: DiagramBuilder, robots: list[Diagram], parameters: Parameters) -> None:
    observer = builder.AddNamedSystem("consensus_error", ConsensusError(*parameters["consensus_error"]))
    for i, robot in enumerate(robots):
        builder.Connect(robot.GetOutputPort("state"), observer.get_input_port(i))
        builder.ExportOutput(observer.get_output_port(i), f"{robot_name(i)}_consensus_error")
