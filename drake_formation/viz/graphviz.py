"""A Drake Diagram as a picture, drawn by Graphviz.

The picture is drawn from what Drake says of the diagram (its subsystems, their ports, their connections) rather than by
restyling Drake's ``GetGraphvizString``: that text numbers its nodes by a counter of the process and lists wires in the
order of their addresses, so it changes from build to build, and tells neither which blocks have state nor which wires
close a loop.

Depth 1 of a formation is the paper's Fig. 2. One robot, ``diagram.GetSubsystemByName("robot_1")``, is its Fig. 3, and
depth 2 of a formation shows both at once.
"""

import html
import re
from collections.abc import Collection, Iterable, Iterator
from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple, TypeGuard

import networkx as nx
from pydrake.systems.framework import Diagram, InputPortIndex, OutputPortIndex, System

from drake_formation.viz.rendering import render, svg

# A wire is coloured by the first word of the input port it enters, a block filled by what it is.
WIRES = {"spring": "#d95f02", "channel": "#1f78b4"}
SIGNAL = "#8a8a8a"
FILLS = {"diagram": "#e8f0fe", "has state": "#fdebd0", "no state": "#eaf5e6"}
EXPORTED = "#1a7f37"


def write_diagram(diagram: Diagram, path: Path, depth: int = 1) -> None:
    """Draw a diagram to a file; see :func:`diagram_dot` and :func:`drake_formation.viz.rendering.render`."""
    render(diagram_dot(diagram, depth), path)


def diagram_svg(diagram: Diagram, depth: int = 1) -> str:
    """A diagram as SVG, for notebooks; see :func:`diagram_dot`."""
    return svg(diagram_dot(diagram, depth))


def diagram_dot(diagram: Diagram, depth: int = 1) -> str:
    """A diagram in Graphviz's language, the same text for every build of the same diagram.

    Every block, port and connection is there, with two liberties. A wire from a nested diagram that closes a loop would
    run back across the whole picture: it starts at a tag with the name of its port instead. A diagram without inputs is
    a whole model, which exports ports only to be logged: these are green instead of wired to its border.

    Args:
        diagram: what to draw.
        depth: 1 draws each subsystem as one block; 2 opens those that are diagrams, and so on.

    Raises:
        ValueError: the depth is less than 1.
    """
    if depth < 1:
        raise ValueError(f"a depth of {depth} shows nothing; 1 shows the subsystems")
    level = _Level(diagram, _name(diagram), depth)
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
label=<{_title(level.node if is_whole else "", picture)}>
}}
"""


class _Wire(NamedTuple):
    """A connection from an output port to an input port."""

    source: System
    output: int
    sink: System
    input: int


class _End(NamedTuple):
    """One end of a wire: where it is in the picture, and the block and port it belongs to."""

    place: str
    block: str
    port: str


class _Level:
    """One diagram in the picture, and what is drawn inside it.

    Nodes are named by their path. As in Drake's own pictures, input ports are u0, u1, … and output ports y0, y1, …; an
    opened diagram holds either kind in a node of its own.
    """

    def __init__(self, diagram: Diagram, node: str, depth: int) -> None:
        self.diagram, self.node, self.depth = diagram, node, depth
        self.nodes = {system: f"{node}::{_name(system, i)}" for i, system in enumerate(diagram.GetSystems())}
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
        yield f'label=<<B>{_last(self.node)}</B>>; bgcolor="{FILLS["diagram"]}"; style=rounded'
        yield from _border(f"{self.node} u", _cells("u", self.diagram))
        yield from self.contents()
        yield from _border(f"{self.node} y", _cells("y", self.diagram, exported))
        for i, port in enumerate(_ports("u", self.diagram)):
            border = _End(f'"{self.node} u":u{i}', _last(self.node), port)
            sinks = self.diagram.GetInputPortLocators(InputPortIndex(i))
            # Drake lists these, like connections, in the order of addresses.
            for system, j in sorted(sinks, key=lambda sink: (list(self.nodes).index(sink[0]), sink[1])):
                yield _edge(border, self._end("u", system, int(j)), _color(port))
        for i, port in enumerate(_ports("y", self.diagram)):
            system, j = self.diagram.get_output_port_locator(OutputPortIndex(i))
            yield _edge(self._end("y", system, int(j)), _End(f'"{self.node} y":y{i}', _last(self.node), port), SIGNAL)
        yield "}"

    def contents(self, mark_exports: bool = False) -> Iterator[str]:
        """The blocks and the wires between them."""
        indices = range(self.diagram.num_output_ports() if mark_exports else 0)
        exports = [self.diagram.get_output_port_locator(OutputPortIndex(i)) for i in indices]
        for system, node in self.nodes.items():
            exported = [int(port) for block, port in exports if block is system]
            if self._is_open(system):
                yield from _Level(system, node, self.depth - 1).boxed(exported)
            else:
                yield _block(node, system, exported)
        yield from self._tags()
        for wire in self.wires:
            source, sink = self._end("y", wire.source, wire.output), self._end("u", wire.sink, wire.input)
            if self._is_feedback(wire):
                source = source._replace(place=f'"{self._tag(wire)}"')
            yield _edge(source, sink, _color(sink.port))

    def _tags(self) -> Iterator[str]:
        """The tags in a column, each beside the block whose output it is."""
        tags = {self._tag(wire): self._node("u", wire.source) for wire in self.wires if self._is_feedback(wire)}
        for tag, block in tags.items():
            yield f'"{tag}" [shape=cds, style=filled, fillcolor=white, fontsize=10, height=0.25, label="{_last(tag)}"]'
            yield f'"{tag}" -> "{block}" [style=invis, weight=100]'
        if tags and self.depth == 1:  # Nodes in boxes cannot be told to share a column.
            yield _column(tags)
            yield _column(tags.values())

    def _tag(self, wire: _Wire) -> str:
        return f"{self.nodes[wire.source]}.{_ports('y', wire.source)[wire.output]}"

    def _is_feedback(self, wire: _Wire) -> bool:
        return isinstance(wire.source, Diagram) and self.loops[wire.source] == self.loops[wire.sink]

    def _is_open(self, system: System) -> TypeGuard[Diagram]:
        return self.depth > 1 and isinstance(system, Diagram)

    def _node(self, kind: str, system: System) -> str:
        """The node that holds a block's ports."""
        return f"{self.nodes[system]} {kind}" if self._is_open(system) else self.nodes[system]

    def _end(self, kind: str, system: System, port: int) -> _End:
        place = f'"{self._node(kind, system)}":{kind}{port}'
        return _End(place, _last(self.nodes[system]), _ports(kind, system)[port])


def _edge(source: _End, sink: _End, color: str) -> str:
    """A wire; the names of its ports show under the mouse in an SVG."""
    tooltip = f"{source.block}.{source.port} → {sink.block}.{sink.port}"
    return f'{source.place}:e -> {sink.place}:w [color="{color}", tooltip="{tooltip}"]'


def _color(input_port: str) -> str:
    return WIRES.get(input_port.partition("_")[0], SIGNAL)


def _column(nodes: Iterable[str]) -> str:
    """Nodes one below the other, in this order."""
    return "{rank=same; edge [style=invis]; " + " -> ".join(f'"{node}"' for node in dict.fromkeys(nodes)) + "}"


def _block(node: str, system: System, exported: Collection[int]) -> str:
    """A block with its name, its type, its inputs on the left and its outputs on the right."""
    cells = zip_longest(_cells("u", system), _cells("y", system, exported), fillvalue="<TD></TD>")
    ports = "".join(f"<TR>{u}{y}</TR>" for u, y in cells)
    kind = f'<FONT POINT-SIZE="9" COLOR="#606060">{_type(system)}</FONT>'
    title = f'<TR><TD COLSPAN="2"><B>{_last(node)}</B><BR/>{kind}</TD></TR>'
    style = f'BORDER="1" CELLBORDER="0" CELLSPACING="0" CELLPADDING="3" STYLE="ROUNDED" BGCOLOR="{_fill(system)}"'
    return f'"{node}" [label=<<TABLE {style}>{title}{ports}</TABLE>>]'


def _border(node: str, cells: list[str]) -> Iterator[str]:
    """The ports of an opened diagram, one above the other, if it has any."""
    if cells:
        rows = "".join(f"<TR>{cell}</TR>" for cell in cells)
        yield f'"{node}" [label=<<TABLE BORDER="0" CELLBORDER="1" CELLSPACING="2" BGCOLOR="white">{rows}</TABLE>>]'


def _cells(kind: str, system: System, exported: Collection[int] = ()) -> list[str]:
    align = {"u": "LEFT", "y": "RIGHT"}[kind]
    names = enumerate(_ports(kind, system))
    texts = [f'<FONT COLOR="{EXPORTED}">{name}</FONT>' if i in exported else name for i, name in names]
    return [f'<TD PORT="{kind}{i}" ALIGN="{align}">{text}</TD>' for i, text in enumerate(texts)]


def _title(name: str, picture: str) -> str:
    """The name of the diagram above a legend of the colours in the picture."""
    wires = {**WIRES, "signal": SIGNAL}
    legend = [f'<TD BGCOLOR="{color}">{kind}</TD>' for kind, color in FILLS.items() if color in picture]
    legend += [f'<TD BORDER="2" SIDES="B" COLOR="{c}">{kind}</TD>' for kind, c in wires.items() if c in picture]
    legend += [f'<TD><FONT COLOR="{EXPORTED}">exported port</FONT></TD>'] if EXPORTED in picture else []
    heading = f'<TR><TD COLSPAN="{len(legend)}"><FONT POINT-SIZE="18"><B>{name}</B></FONT></TD></TR>' if name else ""
    return f'<TABLE BORDER="0" CELLSPACING="8" CELLPADDING="3">{heading}<TR>{"".join(legend)}</TR></TABLE>'


def _name(system: System, index: int = 0) -> str:
    """A block's name; its number replaces the address in the name Drake gives a nameless one."""
    return _text(re.sub(r"@[0-9a-f]{16}$", f"@{index}", system.get_name())) or "diagram"


def _type(system: System) -> str:
    """A block's class without module and scalar type: ``Adder`` for ``drake::systems::Adder<double>``."""
    return _text(re.split(r"::|\.", re.split(r"_?[<\[]", system.GetSystemType())[0])[-1])


def _fill(system: System) -> str:
    if isinstance(system, Diagram):
        return FILLS["diagram"]
    states = system.num_continuous_states() + system.num_discrete_state_groups() + system.num_abstract_states()
    return FILLS["has state" if states else "no state"]


def _ports(kind: str, system: System) -> list[str]:
    """Names of the input ports (u) or the output ports (y)."""
    if kind == "u":
        return [_text(system.get_input_port(i).get_name()) for i in range(system.num_input_ports())]
    return [_text(system.get_output_port(i).get_name()) for i in range(system.num_output_ports())]


def _text(name: str) -> str:
    """A name fit for Graphviz's labels and quotes alike."""
    return html.escape(name).replace("\\", "&#92;")


def _last(node: str) -> str:
    return node.rpartition("::")[-1]
