"""A Drake Diagram as a picture, drawn by Graphviz.

The picture is drawn from what Drake says of the diagram (its subsystems, their ports, their connections) rather than by
restyling Drake's ``GetGraphvizString``: that text numbers its nodes by a counter of the process and lists wires in the
order of their addresses, so it changes from build to build, and tells neither which blocks have state nor which wires
close a loop.

Depth 1 of a formation is the paper's Fig. 2. One robot, ``diagram.GetSubsystemByName("robot_1")``, is its Fig. 3, and
depth 2 of a formation shows both at once.
"""

from collections.abc import Collection, Iterator
from pathlib import Path
from typing import NamedTuple, TypeGuard

import networkx as nx
from pydrake.systems.framework import Diagram, InputPortIndex, OutputPortIndex, System

from drake_formation.viz.graphviz_blocks import (
    FILLS,
    SIGNAL,
    End,
    block_line,
    block_name,
    border_line,
    bundle_name,
    column_line,
    last_name,
    port_cells,
    port_names,
    title_table,
    wire_colour,
    wire_line,
)
from drake_formation.viz.rendering import render, svg


def write_diagram(diagram: Diagram, path: Path, depth: int = 1) -> None:
    """Draw a diagram to a file; see :func:`diagram_dot` and :func:`drake_formation.viz.rendering.render`."""
    render(diagram_dot(diagram, depth), path)


def diagram_svg(diagram: Diagram, depth: int = 1) -> str:
    """A diagram as SVG, for notebooks; see :func:`diagram_dot`."""
    return svg(diagram_dot(diagram, depth))


def diagram_dot(diagram: Diagram, depth: int = 1, *, bundled: bool = False) -> str:
    """A diagram in Graphviz's language, the same text for every build of the same diagram.

    Every block, port and connection is there, with two liberties. A wire from a nested diagram that closes a loop would
    run back across the whole picture: it starts at a tag with the name of its port instead. A diagram without inputs is
    a whole model, which exports ports only to be logged: these are green instead of wired to its border.

    Args:
        diagram: what to draw.
        depth: 1 draws each subsystem as one block; 2 opens those that are diagrams, and so on.
        bundled: draw ports that differ in their number alone, such as ``spring_2`` and ``spring_3``, as one.

    Raises:
        ValueError: the depth is less than 1.
    """
    if depth < 1:
        raise ValueError(f"a depth of {depth} shows nothing; 1 shows the subsystems")
    level = _Level(diagram, block_name(diagram), depth, bundled)
    is_whole = diagram.num_input_ports() == 0
    picture = "\n".join(level.contents(mark_exports=True) if is_whole else level.boxed())
    # Straight wires are easier to follow, but those that run back, as inside a robot, would cling to the blocks.
    splines = "polyline" if is_whole and depth == 1 else "spline"
    # The more wires run between two columns, the further apart these stand: steep wires are hard to follow.
    separation = 0.8 + len(level.wires) / 30
    return f"""digraph {{
graph [rankdir=LR, splines={splines}, ranksep={separation:.2f}, fontname="Helvetica"]
node [shape=plain, fontname="Helvetica", fontsize=11]
edge [arrowsize=0.6]
{picture}
labelloc=t
label=<{title_table(level.node if is_whole else "", picture)}>
}}
"""


class _Wire(NamedTuple):
    """A connection from an output port to an input port."""

    source: System
    output: int
    sink: System
    input: int


class _Level:
    """One diagram in the picture, and what is drawn inside it.

    Nodes are named by their path. As in Drake's own pictures, input ports are u0, u1, … and output ports y0, y1, …; an
    opened diagram holds either kind in a node of its own.
    """

    def __init__(self, diagram: Diagram, node: str, depth: int, bundled: bool) -> None:
        self.diagram, self.node, self.depth, self.bundled = diagram, node, depth, bundled
        self.nodes = {system: f"{node}::{block_name(system, i)}" for i, system in enumerate(diagram.GetSystems())}
        self.wires = self._wires()
        graph = nx.DiGraph((wire.source, wire.sink) for wire in self.wires)
        self.loops = {s: n for n, loop in enumerate(nx.strongly_connected_components(graph)) for s in loop}

    def _wires(self) -> list[_Wire]:
        """The connections, in the order of the ports they come from."""
        order = list(self.nodes).index
        wires = [_Wire(a, int(i), b, int(j)) for (b, j), (a, i) in self.diagram.connection_map().items()]
        return sorted(wires, key=lambda wire: (order(wire.source), wire.output, order(wire.sink), wire.input))

    def boxed(self, exported: Collection[int] = ()) -> Iterator[str]:
        """The diagram as a box, with its own ports at the left and right border."""
        yield f'subgraph "cluster {self.node}" {{'
        yield f'label=<<B>{last_name(self.node)}</B>>; bgcolor="{FILLS["diagram"]}"; style=rounded'
        yield from border_line(f"{self.node} u", port_cells("u", self._ports("u", self.diagram)))
        yield from self.contents()
        yield from border_line(f"{self.node} y", port_cells("y", self._ports("y", self.diagram), exported))
        yield from dict.fromkeys(self._border_edges())  # each once, also where ports are bundled
        yield "}"

    def _border_edges(self) -> Iterator[str]:
        """Wires from the diagram's own input ports and to its output ports."""
        names = self._ports("u", self.diagram)
        for i, port in enumerate(names):
            border = End(f'"{self.node} u":u{names.index(port)}', last_name(self.node), port)
            sinks = self.diagram.GetInputPortLocators(InputPortIndex(i))
            # Drake lists these, like connections, in the order of addresses.
            for system, j in sorted(sinks, key=lambda sink: (list(self.nodes).index(sink[0]), sink[1])):
                yield wire_line(border, self._end("u", system, int(j)), wire_colour(port))
        names = self._ports("y", self.diagram)
        for i, port in enumerate(names):
            system, j = self.diagram.get_output_port_locator(OutputPortIndex(i))
            border = End(f'"{self.node} y":y{names.index(port)}', last_name(self.node), port)
            yield wire_line(self._end("y", system, int(j)), border, SIGNAL)

    def contents(self, mark_exports: bool = False) -> Iterator[str]:
        """The blocks and the wires between them."""
        indices = range(self.diagram.num_output_ports() if mark_exports else 0)
        exports = [self.diagram.get_output_port_locator(OutputPortIndex(i)) for i in indices]
        for system, node in self.nodes.items():
            exported = [int(port) for block, port in exports if block is system]
            if self._is_open(system):
                yield from _Level(system, node, self.depth - 1, self.bundled).boxed(exported)
            else:
                yield block_line(node, system, self._ports("u", system), self._ports("y", system), exported)
        yield from self._tags()
        yield from dict.fromkeys(self._edges())

    def _edges(self) -> Iterator[str]:
        """The wires between the blocks."""
        for wire in self.wires:
            source, sink = self._end("y", wire.source, wire.output), self._end("u", wire.sink, wire.input)
            if self._is_feedback(wire):
                source = source._replace(place=f'"{self._tag(wire)}"')
            yield wire_line(source, sink, wire_colour(sink.port))

    def _tags(self) -> Iterator[str]:
        """The tags in a column, each beside the block whose output it is."""
        tags = {self._tag(wire): self._node("u", wire.source) for wire in self.wires if self._is_feedback(wire)}
        for tag, block in tags.items():
            look = "shape=cds, style=filled, fillcolor=white, fontsize=10, height=0.25"
            yield f'"{tag}" [{look}, label="{last_name(tag)}"]'
            yield f'"{tag}" -> "{block}" [style=invis, weight=100]'
        if tags and self.depth == 1:  # Nodes in boxes cannot be told to share a column.
            yield column_line(tags)
            yield column_line(tags.values())

    def _tag(self, wire: _Wire) -> str:
        return f"{self.nodes[wire.source]}.{self._ports('y', wire.source)[wire.output]}"

    def _is_feedback(self, wire: _Wire) -> bool:
        return isinstance(wire.source, Diagram) and self.loops[wire.source] == self.loops[wire.sink]

    def _is_open(self, system: System) -> TypeGuard[Diagram]:
        return self.depth > 1 and isinstance(system, Diagram)

    def _node(self, kind: str, system: System) -> str:
        """The node that holds a block's ports."""
        return f"{self.nodes[system]} {kind}" if self._is_open(system) else self.nodes[system]

    def _end(self, kind: str, system: System, port: int) -> End:
        names = self._ports(kind, system)
        place = f'"{self._node(kind, system)}":{kind}{names.index(names[port])}'
        return End(place, last_name(self.nodes[system]), names[port])

    def _ports(self, kind: str, system: System) -> list[str]:
        """Names of the input ports (u) or the output ports (y); those of a bundle are alike."""
        names = port_names(kind, system)
        return [bundle_name(name) for name in names] if self.bundled else names
