"""A scenario as a Drake diagram: where blocks are wired (paper, Figs. 2 and 3).

What breaks and fails is wired in :mod:`drake_formation.failing`.
"""

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

import numpy as np
from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort, System
from pydrake.systems.primitives import Adder, ConstantVectorSource, Gain

from drake_formation.failing import Failing
from drake_formation.formation.formation import Formation
from drake_formation.formation.names import channel_name, robot_name
from drake_formation.parameters import Parameters, block_parameters, structure
from drake_formation.parts.part import Part
from drake_formation.parts.registry import PartError
from drake_formation.parts.roles import CONTROLLERS, ROLES, STATE, WIRES, Role
from drake_formation.scenario import Scenario, resolve
from drake_formation.systems.consensus_error import ConsensusError
from drake_formation.systems.hand_off import HandOff
from drake_formation.systems.holding_sensing import HoldingSensing
from drake_formation.systems.line_of_sight import LineOfSight
from drake_formation.systems.sensing import NearestSensing

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

ACCELERATION = "acceleration"
"""An output port of such robots as do not move as the forces on them by their mass say."""

HEADING = "heading"
"""An output port of such robots as have one."""

ROBOT_OPTIONS = (ACCELERATION, HEADING)
"""Output ports that some kinds of robots have."""

DEMANDED, MEASURED = "demanded_force", "measured"
"""Output ports of such robots as have a computer or actuators, and sensors, that are no wires."""

OBJECT_OUTPUTS = ("pose", "strain")
"""Output ports of the carried object, where it is a body of its own, after ``object_``."""

NODES = "nodes"
"""An output port of such objects as are a grid of nodes, likewise."""

PORT_ORDER = ("phase", "reference", "spring", "load", "intact", "held", "failure", "channel", "sensed", "visible")
"""Input ports of every robot, by the stem of their names, as far as its blocks have them."""


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
    reference = _added(builder, "reference", formation, 0, parameters, "reference")
    if reference.num_input_ports():
        builder.Connect(phase.get_output_port(), reference.GetInputPort("phase"))
    robots = [builder.AddNamedSystem(robot_name(i), robot_diagram(formation, i)) for i in range(formation.robots)]
    failing = Failing(builder, formation, parameters)
    for i, robot in enumerate(robots):
        for name in _input_names(robot):
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
    if any("sensed" in _input_names(robot) for robot in robots):
        _sense_nearest(builder, robots, formation, parameters)
    if any("visible" in _input_names(robot) for robot in robots):
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
    return diagram


def robot_diagram(formation: Formation, robot: int) -> Diagram:
    """Build one robot: its plant and its three controllers (paper, Fig. 3), its sensors, computer and actuators.

    Args:
        formation: the robot's.
        robot: index of the robot, from 0.

    Returns:
        The robot, with the input ports that its blocks ask for, of ``phase``, ``reference``, ``spring_j``,
        ``load``, ``channel_j``, ``sensed`` and ``visible``, and the output ports named in ``ROBOT_OUTPUTS``; those of
        ``ROBOT_OPTIONS`` that its plant has, ``DEMANDED`` and ``MEASURED`` where its parts are no wires.

    Raises:
        PartError: a part has not the ports that its role asks for.
    """
    parameters, path = block_parameters(formation), robot_name(robot)
    builder = DiagramBuilder()
    plant = _added(builder, "robot", formation, robot, parameters, f"{path}/plant")
    controllers = [
        _added(builder, role, formation, robot, parameters, f"{path}/{ROLES[role].block}") for role in CONTROLLERS
    ]
    control = builder.AddNamedSystem("control", Adder(len(controllers), 2))
    sensor, computer, actuator = (
        _added_unless_wire(builder, role, formation, robot, parameters, f"{path}/{role}") for role in WIRES
    )
    state, total = plant.GetOutputPort("state"), control.get_output_port()
    demanded = computer.GetOutputPort("demanded") if computer else total
    applied = actuator.GetOutputPort("force") if actuator else demanded
    measured = sensor.GetOutputPort("measured") if sensor else state
    sources = {
        "true_state": state, "state": measured, "spring_force": plant.GetOutputPort("spring_force"),
        "asked": total, "demanded": demanded, "applied": applied, "force": applied,
    }  # fmt: skip

    asked: dict[str, list[System]] = defaultdict(list)
    for block in (plant, *controllers, *filter(None, (sensor, computer, actuator))):
        for name in _input_names(block):
            asked[name].append(block)
    for k, controller in enumerate(controllers):
        builder.Connect(controller.GetOutputPort("force"), control.get_input_port(k))
        builder.ExportOutput(controller.GetOutputPort("force"), f"{controller.get_name()}_force")
    if filters := asked.pop("nominal", ()):
        _connect_nominal(builder, [block for block in controllers if block not in filters], filters)
    for name, source in sources.items():
        for block in asked.pop(name, ()):
            builder.Connect(source, block.GetInputPort(name))
    _export_inputs(builder, asked)
    error = controllers[0].GetOutputPort("error")
    told = {
        "state": state,
        "spring_force": sources["spring_force"],
        "tracking_error": _true_error(builder, error, state, measured) if sensor else error,
        "control_force": applied,
    }
    for name in filter(plant.HasOutputPort, ROBOT_OPTIONS):
        told[name] = plant.GetOutputPort(name)
    if computer or actuator:
        told[DEMANDED] = demanded
    if sensor:
        told[MEASURED] = measured
    for name, port in told.items():
        builder.ExportOutput(port, name)
    return builder.Build()


def _export_inputs(builder: DiagramBuilder, asked: dict[str, list[System]]) -> None:
    """Make inputs of the diagram of what blocks ask for by the names of their ports, one a name."""
    for name in sorted(asked, key=_port_order):
        for block in asked[name]:
            if block is asked[name][0]:
                builder.ExportInput(block.GetInputPort(name), name)
            else:
                builder.ConnectInput(name, block.GetInputPort(name))


def _true_error(builder: DiagramBuilder, error: OutputPort, state: OutputPort, measured: OutputPort) -> OutputPort:
    """The tracking error that a robot has, from the one that it takes itself to have: ε + x − x̂."""
    minus = builder.AddNamedSystem("minus_measured", Gain(-1.0, STATE))
    true = builder.AddNamedSystem("tracking_error", Adder(3, STATE))
    builder.Connect(measured, minus.get_input_port())
    for k, term in enumerate((error, state, minus.get_output_port())):
        builder.Connect(term, true.get_input_port(k))
    port: OutputPort = true.get_output_port()
    return port


def _connect_nominal(builder: DiagramBuilder, others: list[System], filters: Iterable[System]) -> None:
    """Give to the controllers that correct the others' control what those ask for."""
    nominal = builder.AddNamedSystem("nominal", Adder(len(others), 2))
    for k, controller in enumerate(others):
        builder.Connect(controller.GetOutputPort("force"), nominal.get_input_port(k))
    for block in filters:
        builder.Connect(nominal.get_output_port(), block.GetInputPort("nominal"))


def _added(
    builder: DiagramBuilder, role: str, formation: Formation, owner: int, parameters: Parameters, path: str
) -> System:
    """The block of a part, added under the last name of its path; its ports are those of its role."""
    block = _added_unless_wire(builder, role, formation, owner, parameters, path)
    if block is None:
        raise PartError(f"{formation.parts[role][owner].called()}: it has no block")
    return block


def _added_unless_wire(
    builder: DiagramBuilder, role: str, formation: Formation, owner: int, parameters: Parameters, path: str
) -> System | None:
    """The same, or None where the part is a wire."""
    part: Part = formation.parts[role][owner]
    block = part.block(formation, owner, parameters.get(path, ()))
    if block is None:
        return None
    _require_ports(ROLES[role], part, block)
    return builder.AddNamedSystem(path.rsplit("/", maxsplit=1)[-1], block)


def _require_ports(role: Role, part: Part, block: Any) -> None:
    """Refuse a block that the role's wiring would leave out, or that asks for what nobody gives."""
    called = part.called()
    outputs = [block.get_output_port(k).get_name() for k in range(block.num_output_ports())]
    for names, ports, what in ((_input_names(block), role.inputs, "input"), (outputs, role.outputs, "output")):
        for port in ports:
            if port.required and not any(port.is_called(name) for name in names):
                raise PartError(f"{called}: its block has no {what} port {port.name!r} ({port.meaning})")
    for name in _input_names(block):
        if not any(port.is_called(name) for port in role.inputs):
            known = ", ".join(port.name for port in role.inputs)
            raise PartError(f"{called}: nothing is wired to its block's input port {name!r}; there are {known}")


def _input_names(block: Any) -> list[str]:
    return [block.get_input_port(k).get_name() for k in range(block.num_input_ports())]


def _port_order(name: str) -> tuple[int, int]:
    stem, _, number = name.rpartition("_")
    return PORT_ORDER.index(stem or name), int(number) if stem else 0


def _phase(formation: Formation) -> System:
    """The hand-off, or a constant where the scenario starts at transport."""
    return HandOff(formation.hand_off) if formation.aggregation_duration else ConstantVectorSource([1.0])


def _carry(
    builder: DiagramBuilder, phase: System, robots: list[Diagram], formation: Formation, parameters: Parameters
) -> System:
    """Wire an object that is a body of its own to the robots that hold it."""
    (part,) = formation.parts["object"]
    block = _added(builder, "object", formation, 0, parameters, "object")
    for name in _input_names(block):
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
    asked = [set(_input_names(robot)) for robot in robots]
    for k, (i, j) in enumerate(formation.channels.pairs.tolist()):
        name = f"channel_{j + 1}"
        if name not in asked[i]:
            continue
        own, said = (_believed(robots[k]) for k in (i, j))
        heard = robots[i].GetInputPort(name)
        block = _added_unless_wire(builder, "channel", formation, k, parameters, channel_name(i, j))
        if block is None:
            builder.Connect(failing.heard(i, j, said, own), heard)
            continue
        builder.Connect(said, block.GetInputPort("sent"))
        if "own" in _input_names(block):
            builder.Connect(own, block.GetInputPort("own"))
        if block.HasOutputPort("traffic"):
            builder.ExportOutput(block.GetOutputPort("traffic"), f"{channel_name(i, j)}_traffic")
        if "phase" in _input_names(block):
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
    medium = _added(builder, "medium", formation, 0, parameters, "medium")
    for j, robot in enumerate(robots):
        builder.Connect(robot.GetOutputPort("state"), medium.GetInputPort(f"state_{j + 1}"))
    for k, (i, j) in enumerate(formation.channels.pairs.tolist()):
        if f"channel_{j + 1}" not in _input_names(robots[i]):
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
        if port in _input_names(robot):
            builder.Connect(sensing.get_output_port(i), robot.GetInputPort(port))


def _observe_consensus(builder: DiagramBuilder, robots: Iterable[Diagram], parameters: Parameters) -> None:
    observer = builder.AddNamedSystem("consensus_error", ConsensusError(*parameters["consensus_error"]))
    for i, robot in enumerate(robots):
        builder.Connect(robot.GetOutputPort("state"), observer.get_input_port(i))
        builder.ExportOutput(observer.get_output_port(i), f"{robot_name(i)}_consensus_error")
