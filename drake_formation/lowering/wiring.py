"""The blocks of a nested diagram in a row, and which output feeds which input."""

from collections.abc import Iterator
from typing import Any

from pydrake.systems.framework import Diagram, InputPortIndex, OutputPortIndex

Port = tuple[Any, int]
"""A system and the index of one of its ports."""


class Wiring:
    """A diagram without its nesting.

    Args:
        diagram: any Drake diagram.

    Attributes:
        blocks: its leaf systems by path, such as ``robot_1/plant``, in Drake's order.
    """

    def __init__(self, diagram: Diagram) -> None:
        self._diagram = diagram
        self._parents: dict[Any, Diagram] = {}
        self._sources: dict[Port, Port] = {}
        self._exported: dict[Port, int] = {}
        self._found: dict[Port, Port | None] = {}
        self.blocks: dict[str, Any] = dict(self._flatten(diagram, ""))

    def source(self, block: Any, port: int) -> Port | None:
        """The leaf system and output port that feed an input port, or None where it comes from outside."""
        key = (block, port)
        if key not in self._found:
            self._found[key] = self._source(block, port)
        return self._found[key]

    def _source(self, block: Any, port: int) -> Port | None:
        system: Any = block
        while system is not self._diagram:
            if (system, port) in self._sources:
                return self.leaf(*self._sources[system, port])
            if (system, port) not in self._exported:
                return None
            system, port = self._parents[system], self._exported[system, port]
        return None

    def leaf(self, system: Any, port: int) -> Port:
        """The leaf system and output port behind an output port of a diagram."""
        while isinstance(system, Diagram):
            system, index = system.get_output_port_locator(OutputPortIndex(port))
            port = int(index)
        return system, port

    def _flatten(self, diagram: Diagram, prefix: str) -> Iterator[tuple[str, Any]]:
        for (system, port), (source, output) in diagram.connection_map().items():
            self._sources[system, int(port)] = (source, int(output))
        for k in range(diagram.num_input_ports()):
            for system, port in diagram.GetInputPortLocators(InputPortIndex(k)):
                self._exported[system, int(port)] = k
        for system in diagram.GetSystems():
            self._parents[system] = diagram
            path = f"{prefix}{system.get_name()}"
            if isinstance(system, Diagram):
                yield from self._flatten(system, f"{path}/")
            else:
                yield path, system
