"""Blocks of parts in a diagram, with the ports that their roles have."""

from typing import Any

from pydrake.systems.framework import DiagramBuilder, System

from drake_formation.formation.formation import Formation
from drake_formation.parameters import Parameters
from drake_formation.parts.part import Part
from drake_formation.parts.registry import PartError
from drake_formation.parts.roles import ROLES, Role


def added(
    builder: DiagramBuilder, role: str, formation: Formation, owner: int, parameters: Parameters, path: str
) -> System:
    """Add the block of a part to a diagram.

    Args:
        builder: of the diagram.
        role: the part's.
        formation: where the part is.
        owner: index of its robot or channel, 0 for the formation's own.
        parameters: of all blocks.
        path: the block's, such as ``robot_1/plant``; it is added under the last name of it.

    Raises:
        PartError: there is no block, or its ports are not those of the role.
    """
    block = added_unless_wire(builder, role, formation, owner, parameters, path)
    if block is None:
        raise PartError(f"{formation.parts[role][owner].called()}: it has no block")
    return block


def added_unless_wire(
    builder: DiagramBuilder, role: str, formation: Formation, owner: int, parameters: Parameters, path: str
) -> System | None:
    """As :func:`added`, or None where the part is a wire."""
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
    for names, ports, what in ((input_names(block), role.inputs, "input"), (outputs, role.outputs, "output")):
        for port in ports:
            if port.required and not any(port.is_called(name) for name in names):
                raise PartError(f"{called}: its block has no {what} port {port.name!r} ({port.meaning})")
    for name in input_names(block):
        if not any(port.is_called(name) for port in role.inputs):
            known = ", ".join(port.name for port in role.inputs)
            raise PartError(f"{called}: nothing is wired to its block's input port {name!r}; there are {known}")


def input_names(block: Any) -> list[str]:
    """Names of a block's input ports."""
    return [block.get_input_port(k).get_name() for k in range(block.num_input_ports())]
