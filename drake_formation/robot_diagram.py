"""One robot as a Drake diagram (paper, Fig. 3)."""

from collections import defaultdict
from collections.abc import Iterable

from pydrake.systems.framework import Diagram, DiagramBuilder, OutputPort, System
from pydrake.systems.primitives import Adder, Gain

from drake_formation.blocks import added, added_unless_wire, input_names
from drake_formation.formation.formation import Formation
from drake_formation.formation.names import robot_name
from drake_formation.parameters import block_parameters
from drake_formation.parts.roles import CONTROLLERS, ROLES, STATE, WIRES

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

PORT_ORDER = ("phase", "reference", "spring", "load", "intact", "held", "failure", "channel", "sensed", "visible")
"""Input ports of every robot, by the stem of their names, as far as its blocks have them."""


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
    plant = added(builder, "robot", formation, robot, parameters, f"{path}/plant")
    controllers = [
        added(builder, role, formation, robot, parameters, f"{path}/{ROLES[role].block}") for role in CONTROLLERS
    ]
    control = builder.AddNamedSystem("control", Adder(len(controllers), 2))
    sensor, computer, actuator = (
        added_unless_wire(builder, role, formation, robot, parameters, f"{path}/{role}") for role in WIRES
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
        for name in input_names(block):
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


def _port_order(name: str) -> tuple[int, int]:
    stem, _, number = name.rpartition("_")
    return PORT_ORDER.index(stem or name), int(number) if stem else 0
