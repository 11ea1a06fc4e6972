"""A scenario as a Drake diagram: robots, the object and channels between them (paper, Fig. 2).

One robot is wired in :mod:`drake_formation.robot_diagram`, and what breaks and fails in :mod:`drake_formation.failing`;
nothing else wires blocks.
"""

from collections.abc import Iterable

import numpy as np
from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort, System
from pydrake.systems.primitives import ConstantVectorSource

from drake_formation.blocks import added, added_unless_wire, input_names
from drake_formation.display.diagram import show_diagrams
from drake_formation.failing import Failing
from drake_formation.formation.formation import Formation
from drake_formation.formation.names import channel_name, robot_name
from drake_formation.parameters import Parameters, block_parameters, structure
from drake_formation.parts.registry import PartError
from drake_formation.robot_diagram import DEMANDED, MEASURED, ROBOT_OPTIONS, ROBOT_OUTPUTS, robot_diagram
from drake_formation.scenario import Scenario, resolve
from drake_formation.systems.consensus_error import ConsensusError
from drake_formation.systems.hand_off import HandOff
from drake_formation.systems.holding_sensing import HoldingSensing
from drake_formation.systems.line_of_sight import LineOfSight
from drake_formation.systems.sensing import NearestSensing

OBJECT_OUTPUTS = ("pose", "strain")
"""Output ports of the carried object, where it is a body of its own, after ``object_``."""

NODES = "nodes"
"""An output port of such objects as are a grid of nodes, likewise."""


show_diagrams()


def build_diagram(scenario: Scenario) -> Diagram:
    """Build the block diagram of a scenario.

    Its default Context is the scenario's initial state. The hand-off is an event of the diagram that changes
    discrete state, which Drake's ``Linearize`` does not take: at ``aggregation.duration`` 0 there is none, and
    :func:`drake_formation.analysis.at_rest` gives a scenario that starts where its diagram can be linearized. Output
    ports, for every robot i from 1: ``robot_i_state`` (m, m/s), ``robot_i_tracking_error`` x − x_r (m, m/s),
    ``robot_i_consensus_error`` (m), and in newtons ``robot_i_tracking_force`` u_l, ``robot_i_consensus_force`` u_g,
    ``robot_i_avoidance_force``, ``robot_i_control_force`` (what the actuators exert of the sum of the three: all of it
    where they are ideal) and ``robot_i_spring_force``; of robots whose computer or actuators are no wires
    ``robot_i_demanded_force`` (what is asked of the actuators: the sum of the three, or what a computer holds of it);
    of robots whose sensors are no wires ``robot_i_measured`` (what they take for their state and send; ``state`` and
    ``tracking_error`` are the true ones); of robots that are no free masses ``robot_i_acceleration`` (m/s²) and of
    those that have one ``robot_i_heading`` (rad); of an object that is a body of its own ``object_pose`` (x, y, heading
    and their rates; m, rad), ``object_strain`` and, if it is a grid, ``object_nodes`` (m); and ``phase`` (0
    aggregation, 1 transport).

    Args:
        scenario: what to build.

    Returns:
        The diagram, in double; it converts to AutoDiffXd and Expression.

    Raises:
        ScenarioError: the scenario is wrong.
        PartError: a part has not the ports that its role asks for.
    """
    return wired(resolve(scenario))


def wired(formation: Formation) -> Diagram:
    """Build the block diagram of a formation; see :func:`build_diagram`."""
    parameters = block_parameters(formation)
    builder = DiagramBuilder()
    phase = builder.AddNamedSystem("phase", _phase(formation))
    reference = added(builder, "reference", formation, 0, parameters, "reference")
    if reference.num_input_ports():
        builder.Connect(phase.get_output_port(), reference.GetInputPort("phase"))
    robots = [builder.AddNamedSystem(robot_name(i), robot_diagram(formation, i)) for i in range(formation.robots)]
    failing = Failing(builder, formation, parameters)
    for i, robot in enumerate(robots):
        for name in input_names(robot):
            stem, _, number = name.rpartition("_")
            if name == "phase":
                builder.Connect(phase.get_output_port(), robot.GetInputPort(name))
            elif name == "reference":
                builder.Connect(failing.reference(i, reference.GetOutputPort("centre")), robot.GetInputPort(name))
            elif stem == "spring":
                builder.Connect(robots[int(number) - 1].GetOutputPort("state"), robot.GetInputPort(name))
    carried = _carry(builder, phase, robots, formation, parameters) if formation.has_body else None
    failing.fail(robots, carried)
    _talk(builder, phase, robots, formation, parameters, failing)
    if any("sensed" in input_names(robot) for robot in robots):
        _sense_nearest(builder, robots, formation, parameters)
    if any("visible" in input_names(robot) for robot in robots):
        obstacles, footprints, _ = parameters["line_of_sight"]
        block = LineOfSight(obstacles, footprints, formation.obstacles.layout)
        _sense(builder, robots, block, "line_of_sight", "visible")
    for i, robot in enumerate(robots):
        for output in (*ROBOT_OUTPUTS, *ROBOT_OPTIONS, DEMANDED, MEASURED):
            if output in ROBOT_OUTPUTS or robot.HasOutputPort(output):
                builder.ExportOutput(robot.GetOutputPort(output), f"{robot_name(i)}_{output}")
    _observe_consensus(builder, robots, parameters)
    builder.ExportOutput(phase.get_output_port(), "phase")
    diagram = builder.Build()
    diagram.set_name(formation.name)
    diagram.structure = structure(formation)  # set_parameters compares
    diagram.formation = formation  # for who looks at it in a notebook
    return diagram


def _phase(formation: Formation) -> System:
    """The hand-off, or a constant where the scenario starts at transport."""
    return HandOff(formation.hand_off) if formation.aggregation_duration else ConstantVectorSource([1.0])


def _carry(
    builder: DiagramBuilder, phase: System, robots: list[Diagram], formation: Formation, parameters: Parameters
) -> System:
    """Wire an object that is a body of its own to the robots that hold it."""
    (part,) = formation.parts["object"]
    block = added(builder, "object", formation, 0, parameters, "object")
    for name in input_names(block):
        _, _, number = name.rpartition("_")
        if number.isdecimal():
            builder.Connect(robots[int(number) - 1].GetOutputPort("state"), block.GetInputPort(name))
        elif name == "phase":
            builder.Connect(phase.get_output_port(), block.GetInputPort(name))
    for i, robot in enumerate(robots):
        name, plant = f"grip_force_{i + 1}", formation.parts["robot"][i]
        if not block.HasOutputPort(name):
            raise PartError(f"{part.called()}: its block has no output port {name!r} for robot {i + 1}")
        if not robot.HasInputPort("load"):
            raise PartError(f"{plant.called()}: its block has no input port 'load' for what {part.called()} exerts")
        builder.Connect(block.GetOutputPort(name), robot.GetInputPort("load"))
    for name in (*OBJECT_OUTPUTS, NODES):
        if name in OBJECT_OUTPUTS or block.HasOutputPort(name):
            builder.ExportOutput(block.GetOutputPort(name), f"object_{name}")
    return block


def _talk(
    builder: DiagramBuilder,
    phase: System,
    robots: list[Diagram],
    formation: Formation,
    parameters: Parameters,
    failing: Failing,
) -> None:
    """Wire every channel from the robot that speaks to the one that hears, through the channel's block if any."""
    medium = _medium(builder, robots, formation, parameters)
    asked = [set(input_names(robot)) for robot in robots]
    for k, (i, j) in enumerate(formation.channels.pairs.tolist()):
        name = f"channel_{j + 1}"
        if name not in asked[i]:
            continue
        own, said = (_believed(robots[k]) for k in (i, j))
        heard = robots[i].GetInputPort(name)
        block = added_unless_wire(builder, "channel", formation, k, parameters, channel_name(i, j))
        if block is None:
            builder.Connect(failing.heard(i, j, said, own), heard)
            continue
        builder.Connect(said, block.GetInputPort("sent"))
        if "own" in input_names(block):
            builder.Connect(own, block.GetInputPort("own"))
        if block.HasOutputPort("traffic"):
            builder.ExportOutput(block.GetOutputPort("traffic"), f"{channel_name(i, j)}_traffic")
        if "phase" in input_names(block):
            builder.Connect(phase.get_output_port(), block.GetInputPort("phase"))
        if medium:
            builder.Connect(block.GetOutputPort("traffic"), medium.GetInputPort(f"traffic_{k + 1}"))
            builder.Connect(medium.GetOutputPort(f"through_{k + 1}"), block.GetInputPort("through"))
        builder.Connect(failing.heard(i, j, block.GetOutputPort("received"), own), heard)


def _medium(
    builder: DiagramBuilder, robots: list[Diagram], formation: Formation, parameters: Parameters
) -> System | None:
    """The medium that all channels share, if they do; those that nobody listens to offer nothing to it."""
    if not formation.has_medium:
        return None
    medium = added(builder, "medium", formation, 0, parameters, "medium")
    for j, robot in enumerate(robots):
        builder.Connect(robot.GetOutputPort("state"), medium.GetInputPort(f"state_{j + 1}"))
    for k, (i, j) in enumerate(formation.channels.pairs.tolist()):
        if f"channel_{j + 1}" not in input_names(robots[i]):
            silent = builder.AddNamedSystem(f"{channel_name(i, j)}_silent", ConstantVectorSource(np.zeros(6)))
            builder.Connect(silent.get_output_port(), medium.GetInputPort(f"traffic_{k + 1}"))
    builder.ExportOutput(medium.GetOutputPort("airtime"), "medium_airtime")
    return medium


def _believed(robot: Diagram) -> OutputPort:
    """What a robot takes for its state, and sends."""
    port: OutputPort = robot.GetOutputPort(MEASURED if robot.HasOutputPort(MEASURED) else "state")
    return port


def _sense_nearest(
    builder: DiagramBuilder, robots: list[Diagram], formation: Formation, parameters: Parameters
) -> None:
    obstacles, *margin = parameters["sensing"]
    kind = HoldingSensing if margin else NearestSensing
    block = kind(len(robots), obstacles, *margin, formation.obstacles.layout)
    _sense(builder, robots, block, "sensing", "sensed")


def _sense(builder: DiagramBuilder, robots: list[Diagram], block: System, name: str, port: str) -> None:
    """Wire a block that tells every robot about the obstacles, from the states of all, to those that ask for it."""
    sensing = builder.AddNamedSystem(name, block)
    for i, robot in enumerate(robots):
        builder.Connect(robot.GetOutputPort("state"), sensing.get_input_port(i))
        if port in input_names(robot):
            builder.Connect(sensing.get_output_port(i), robot.GetInputPort(port))


def _observe_consensus(builder: DiagramBuilder, robots: Iterable[Diagram], parameters: Parameters) -> None:
    observer = builder.AddNamedSystem("consensus_error", ConsensusError(*parameters["consensus_error"]))
    for i, robot in enumerate(robots):
        builder.Connect(robot.GetOutputPort("state"), observer.get_input_port(i))
        builder.ExportOutput(observer.get_output_port(i), f"{robot_name(i)}_consensus_error")
