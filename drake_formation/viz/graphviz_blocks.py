"""Blocks, ports and wires in Graphviz's language."""

import html
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from itertools import zip_longest
from typing import NamedTuple

from pydrake.systems.framework import Diagram, System

# A wire is coloured by the first word of the input port it enters, a block filled by what it is.
WIRES = {"spring": "#d95f02", "channel": "#1f78b4"}
SIGNAL = "#8a8a8a"
FILLS = {"diagram": "#e8f0fe", "has state": "#fdebd0", "no state": "#eaf5e6"}
EXPORTED = "#1a7f37"


class End(NamedTuple):
    """One end of a wire: where it is in the picture, and the block and port it belongs to."""

    place: str
    block: str
    port: str


def wire_line(source: End, sink: End, color: str) -> str:
    """A wire; the names of its ports show under the mouse in an SVG."""
    tooltip = f"{source.block}.{source.port} → {sink.block}.{sink.port}"
    return f'{source.place}:e -> {sink.place}:w [color="{color}", tooltip="{tooltip}"]'


def wire_colour(input_port: str) -> str:
    """Of a wire, by the input port that it enters."""
    return WIRES.get(input_port.partition("_")[0], SIGNAL)


def column_line(nodes: Iterable[str]) -> str:
    """Nodes one below the other, in this order."""
    return "{rank=same; edge [style=invis]; " + " -> ".join(f'"{node}"' for node in dict.fromkeys(nodes)) + "}"


def block_line(node: str, system: System, inputs: list[str], outputs: list[str], exported: Collection[int]) -> str:
    """A block with its name, its type, its inputs on the left and its outputs on the right."""
    cells = zip_longest(port_cells("u", inputs), port_cells("y", outputs, exported), fillvalue="<TD></TD>")
    ports = "".join(f"<TR>{u}{y}</TR>" for u, y in cells)
    kind = f'<FONT POINT-SIZE="9" COLOR="#606060">{block_type(system)}</FONT>'
    title = f'<TR><TD COLSPAN="2"><B>{last_name(node)}</B><BR/>{kind}</TD></TR>'
    style = f'BORDER="1" CELLBORDER="0" CELLSPACING="0" CELLPADDING="3" STYLE="ROUNDED" BGCOLOR="{block_fill(system)}"'
    return f'"{node}" [label=<<TABLE {style}>{title}{ports}</TABLE>>]'


def border_line(node: str, cells: list[str]) -> Iterator[str]:
    """The ports of an opened diagram, one above the other, if it has any."""
    if cells:
        rows = "".join(f"<TR>{cell}</TR>" for cell in cells)
        yield f'"{node}" [label=<<TABLE BORDER="0" CELLBORDER="1" CELLSPACING="2" BGCOLOR="white">{rows}</TABLE>>]'


def port_cells(kind: str, names: list[str], exported: Collection[int] = ()) -> list[str]:
    """A cell for each name, with how many ports have it if that is not one."""
    align = {"u": "LEFT", "y": "RIGHT"}[kind]
    counts = Counter(names)
    texts = {name: name if count == 1 else f"{name} ({count})" for name, count in counts.items()}
    shown = {name: f'<FONT COLOR="{EXPORTED}">{texts[name]}</FONT>' for i, name in enumerate(names) if i in exported}
    return [
        f'<TD PORT="{kind}{names.index(name)}" ALIGN="{align}">{shown.get(name, text)}</TD>'
        for name, text in texts.items()
    ]


def title_table(name: str, picture: str) -> str:
    """The name of the diagram above a legend of the colours in the picture."""
    wires = {**WIRES, "signal": SIGNAL}
    legend = [f'<TD BGCOLOR="{color}">{kind}</TD>' for kind, color in FILLS.items() if color in picture]
    legend += [f'<TD BORDER="2" SIDES="B" COLOR="{c}">{kind}</TD>' for kind, c in wires.items() if c in picture]
    legend += [f'<TD><FONT COLOR="{EXPORTED}">exported port</FONT></TD>'] if EXPORTED in picture else []
    heading = f'<TR><TD COLSPAN="{len(legend)}"><FONT POINT-SIZE="18"><B>{name}</B></FONT></TD></TR>' if name else ""
    return f'<TABLE BORDER="0" CELLSPACING="8" CELLPADDING="3">{heading}<TR>{"".join(legend)}</TR></TABLE>'


def block_name(system: System, index: int = 0) -> str:
    """A block's name; its number replaces the address in the name Drake gives a nameless one."""
    return escaped(re.sub(r"@[0-9a-f]{16}$", f"@{index}", system.get_name())) or "diagram"


def block_type(system: System) -> str:
    """A block's class without module and scalar type: ``Adder`` for ``drake::systems::Adder<double>``."""
    return escaped(re.split(r"::|\.", re.split(r"_?[<\[]", system.GetSystemType())[0])[-1])


def block_fill(system: System) -> str:
    """The colour of a block, by what it is."""
    if isinstance(system, Diagram):
        return FILLS["diagram"]
    states = system.num_continuous_states() + system.num_discrete_state_groups() + system.num_abstract_states()
    return FILLS["has state" if states else "no state"]


def port_names(kind: str, system: System) -> list[str]:
    """Names of the input ports (u) or the output ports (y) of a block, fit for Graphviz."""
    if kind == "u":
        return [escaped(system.get_input_port(i).get_name()) for i in range(system.num_input_ports())]
    return [escaped(system.get_output_port(i).get_name()) for i in range(system.num_output_ports())]


def bundle_name(name: str) -> str:
    """A name without its number."""
    stem, _, number = name.rpartition("_")
    return f"{stem}_j" if stem and number.isdecimal() else name


def escaped(name: str) -> str:
    """A name fit for Graphviz's labels and quotes alike."""
    return html.escape(name).replace("\\", "&#92;")


def last_name(node: str) -> str:
    """The last name of a node's path."""
    return node.rpartition("::")[-1]
