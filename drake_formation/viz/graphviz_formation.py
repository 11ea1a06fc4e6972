"""A formation at a glance: its robots at their slots, who holds and who hears whom, and one robot opened beside it.

The block diagram has a wire for every port, 112 for eight robots that all hold and hear each other. Here the springs
between two robots are one line and the channels between them another, beside it; and in the robot that is opened, ports
that differ in their number alone are one. What is drawn is what Drake says is wired; the slots are the scenario's.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import Diagram

from drake_formation.diagram import wired
from drake_formation.formation.formation import Formation
from drake_formation.formation.names import robot_name
from drake_formation.viz.graphviz import diagram_dot
from drake_formation.viz.graphviz_blocks import FILLS, SIGNAL, WIRES, escaped, port_names
from drake_formation.viz.rendering import laid_out, render

Array = NDArray[np.float64]

CLOSEST, SMALLEST, LARGEST = 45.0, 230.0, 620.0
"""How far apart robots are drawn at the least, if the formation is not larger or smaller than this in all (points)."""

SIZE = 24.0
"""Diameter of a robot, unless robots are so close that it must be less (points)."""

GAP = 70.0
"""Between the formation and the robot that is opened (points)."""

MANY, FAINT = 120, "40"
"""With more lines than this, all but those of the robot that is opened are faint: how opaque, of ff."""


class Line(NamedTuple):
    """A line between two robots, from 0.

    Attributes:
        kind: ``spring`` or ``channel``.
        start: the robot where it begins.
        end: the robot where it ends.
        one_way: whether it is a channel over which only the end hears.
    """

    kind: str
    start: int
    end: int
    one_way: bool = False


def write_formation(formation: Formation, path: Path) -> None:
    """Draw a formation to a file; see :func:`formation_dot` and :func:`drake_formation.viz.rendering.render`."""
    render(formation_dot(formation), path)


def formation_dot(formation: Formation) -> str:
    """A formation in Graphviz's language, laid out already; the same text for the same formation.

    The robot that is opened is the one on the right, next to its inside.
    """
    opened = int(np.round(formation.slots[:, 0], 6).argmax())
    diagram = wired(formation)
    lines = lines_of(diagram, formation.robots)
    robot = laid_out(diagram_dot(diagram.GetSubsystemByName(robot_name(opened)), bundled=True))
    _, _, _, height = (float(number) for number in re.search(r'bb="([^"]+)"', robot)[1].split(","))  # type: ignore[index]
    places, size = _places(formation.slots, height / 2)
    drawn = "\n".join(
        [
            *_robots(places, size),
            *_opened(places, size, opened, height),
            *_lines(lines, places, size, opened),
            _legend(formation, lines, places),
        ]
    )
    head, _, _ = robot.rstrip().rpartition("}")
    # Of an engine that leaves everything where it is.
    return head.replace("digraph {", "digraph {\n\tlayout=nop2; outputorder=edgesfirst;", 1) + drawn + "\n}\n"


def lines_of(diagram: Diagram, robots: int) -> list[Line]:
    """What is wired between the robots of a formation diagram: springs first, then channels."""
    asked = [port_names("u", diagram.GetSubsystemByName(robot_name(i))) for i in range(robots)]

    def others(kind: str) -> set[tuple[int, int]]:
        """Pairs of a robot and one that it has a port for."""
        ports = ((i, name.rpartition("_")) for i, names in enumerate(asked) for name in names)
        return {(i, int(number) - 1) for i, (stem, _, number) in ports if stem == kind}

    held, heard = others("spring"), others("channel")
    springs = [Line("spring", i, j) for i, j in sorted({(min(pair), max(pair)) for pair in held})]
    both = [Line("channel", i, j) for i, j in sorted(heard) if i < j and (j, i) in heard]
    one_way = [Line("channel", j, i, True) for i, j in sorted(heard) if (j, i) not in heard]
    return [*springs, *both, *one_way]


def _places(slots: Array, middle: float) -> tuple[Array, float]:
    """Where robots are drawn (points), left of the origin about some height, and their diameter."""
    apart = np.linalg.norm(slots[:, None] - slots, axis=-1)[~np.eye(len(slots), dtype=bool)].min(initial=np.inf)
    extent = max(float(np.ptp(slots, axis=0).max()), 1e-9)
    if not np.isfinite(apart):
        return np.array([[-GAP - SIZE, middle]]), SIZE
    scale = float(np.clip(CLOSEST / apart, SMALLEST / extent, LARGEST / extent))
    places = scale * (slots - slots.max(axis=0) * [1.0, 0.5] - slots.min(axis=0) * [0.0, 0.5])
    return places + np.array([-GAP - SIZE, middle]), min(SIZE, 0.6 * scale * float(apart))


def _robots(places: Array, size: float) -> Iterator[str]:
    """The robots by their numbers."""
    for i, (x, y) in enumerate(places):
        look = f"shape=circle, fixedsize=true, width={size / 72:.3f}, fontsize={0.5 * size:.1f}"
        fill = f'style=filled, fillcolor="{FILLS["diagram"]}"'
        yield f'"{robot_name(i)}" [{look}, {fill}, label="{i + 1}", tooltip="{robot_name(i)}", pos="{x:.2f},{y:.2f}"]'


def _opened(places: Array, size: float, opened: int, height: float) -> Iterator[str]:
    """A bold border of the robot that is opened, and a line from it to its inside."""
    yield f'"{robot_name(opened)}" [penwidth=2.5]'
    x, y = places[opened]
    start, inside = np.array([x + size / 2, y]), np.array([8.0, np.clip(y, 0.1 * height, 0.7 * height)])
    yield f'"inside" [shape=point, style=invis, width=0.01, label="", pos="{_at(inside)}"]'
    look = f'color="{SIGNAL}", style=dashed, dir=none'
    yield f'"{robot_name(opened)}" -> "inside" [{look}, pos="{_straight(start, inside)}"]'


def _lines(lines: list[Line], places: Array, size: float, opened: int) -> Iterator[str]:
    """The lines; springs run on the one side of the straight way between two robots, channels on the other."""
    aside = 0.09 * size
    many = len(lines) > MANY
    # Those that are drawn over others come last.
    for line in sorted(lines, key=lambda line: opened in (line.start, line.end)):
        faint = many and opened not in (line.start, line.end)
        colour, width = WIRES[line.kind] + (FAINT if faint else ""), 0.6 if faint else 1.4
        begin, end = places[line.start], places[line.end]
        along = (end - begin) / max(float(np.linalg.norm(end - begin)), 1e-9)
        # The same side of a pair of robots, whichever way a channel goes.
        sign = (1 if line.kind == "spring" else -1) * (1 if line.start < line.end else -1)
        off, reach = sign * aside * np.array([-along[1], along[0]]), np.sqrt((size / 2) ** 2 - aside**2)
        first, last = begin + reach * along + off, end - reach * along + off
        head = f"e,{_at(last)} " if line.one_way else ""
        last = last - 6.0 * along if line.one_way else last
        arrow = "dir=forward, arrowsize=0.6" if line.one_way else "dir=none"
        join = "to" if line.one_way else "with"
        tooltip = f"{line.kind} {line.start + 1} {join} {line.end + 1}"
        look = f'color="{colour}", penwidth={width}, {arrow}, tooltip="{tooltip}"'
        ends = f'"{robot_name(line.start)}" -> "{robot_name(line.end)}"'
        yield f'{ends} [{look}, pos="{head}{_straight(first, last)}"]'


def _legend(formation: Formation, lines: list[Line], places: Array) -> str:
    """The name of the formation, and what its lines are, above it."""
    rows = []
    springs = [line for line in lines if line.kind == "spring"]
    if springs:
        every = _every(len(springs), formation.robots)
        rows.append((WIRES["spring"], f"{_count(springs, 'spring')} of the object{every}"))
    elif formation.has_body:
        rows.append((SIGNAL, f"object: {escaped(formation.parts['object'][0].kind)}, held by every robot"))
    both = [line for line in lines if line.kind == "channel" and not line.one_way]
    if both:
        every = _every(len(both), formation.robots)
        rows.append((WIRES["channel"], f"{_count(both, 'channel')}, both ways{every}"))
    if one_way := [line for line in lines if line.one_way]:
        rows.append((WIRES["channel"], f"{_count(one_way, 'channel')} one way, to the robot that hears"))
    cells = "".join(f'<TR><TD BORDER="2" SIDES="B" COLOR="{colour}">{words}</TD></TR>' for colour, words in rows)
    name = f'<TR><TD><FONT POINT-SIZE="18"><B>{escaped(formation.name)}</B></FONT></TD></TR>'
    x, y = 0.5 * (places.min(axis=0) + places.max(axis=0))[0], places[:, 1].max() + 60.0 + 10.0 * len(rows)
    return f'"legend" [label=<<TABLE BORDER="0" CELLSPACING="6">{name}{cells}</TABLE>>, pos="{x:.2f},{y:.2f}"]'


def _count(lines: list[Line], what: str) -> str:
    return f"1 {what}" if len(lines) == 1 else f"{len(lines)} {what}s"


def _every(lines: int, robots: int) -> str:
    return ": every pair" if robots > 2 and 2 * lines == robots * (robots - 1) else ""


def _at(place: Array) -> str:
    x, y = place
    return f"{x:.2f},{y:.2f}"


def _straight(first: Array, last: Array) -> str:
    """A straight line as Graphviz has it, a Bézier curve."""
    return " ".join(_at(first + share * (last - first)) for share in (0.0, 1 / 3, 2 / 3, 1.0))
