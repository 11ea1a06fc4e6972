"""Block diagrams drawn by Graphviz, on a formation of mock blocks."""

import re
import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.systems.framework import Diagram, DiagramBuilder, LeafSystem
from pydrake.systems.primitives import Adder

from drake_formation.viz.graphviz import diagram_dot, write_diagram
from drake_formation.viz.graphviz_blocks import SIGNAL, WIRES
from drake_formation.viz.rendering import render

EDGE = re.compile(r'^(".+?"(?::y\d+|:u\d+)?):e -> (".+?":[uy]\d+):w \[color="(#\w+)", tooltip="(.+) → (.+)"\]$', re.M)
CONTROLLERS = ("tracking", "consensus", "avoidance")


class Block(LeafSystem):
    """Ports of any names and no law; with a state where asked."""

    def __init__(self, inputs: list[str], outputs: list[str], states: int = 0) -> None:
        super().__init__()
        if states:
            self.DeclareContinuousState(states)
        for name in inputs:
            self.DeclareVectorInputPort(name, 2)
        for name in outputs:
            self.DeclareVectorOutputPort(name, 2, lambda context, output: None, {self.nothing_ticket()})


def mock_robot(held: list[int], heard: list[int]) -> Diagram:
    springs, channels = [f"spring_{j}" for j in held], [f"channel_{j}" for j in heard]
    builder = DiagramBuilder()
    plant = builder.AddNamedSystem("plant", Block(["force", "phase", *springs], ["state", "spring_force"], states=4))
    tracking = builder.AddNamedSystem("tracking", Block(["state", "reference"], ["force", "error"]))
    consensus = builder.AddNamedSystem("consensus", Block(["state", *channels], ["force"]))
    avoidance = builder.AddNamedSystem("avoidance", Block(["state", "phase"], ["force"]))
    control = builder.AddNamedSystem("control", Adder(3, 2))
    for k, controller in enumerate((tracking, consensus, avoidance)):
        builder.Connect(plant.GetOutputPort("state"), controller.GetInputPort("state"))
        builder.Connect(controller.GetOutputPort("force"), control.get_input_port(k))
    builder.Connect(control.get_output_port(), plant.GetInputPort("force"))
    builder.ExportInput(plant.GetInputPort("phase"), "phase")
    builder.ConnectInput("phase", avoidance.GetInputPort("phase"))
    builder.ExportInput(tracking.GetInputPort("reference"), "reference")
    for block, names in ((plant, springs), (consensus, channels)):
        for name in names:
            builder.ExportInput(block.GetInputPort(name), name)
    builder.ExportOutput(plant.GetOutputPort("state"), "state")
    builder.ExportOutput(control.get_output_port(), "control_force")
    return builder.Build()


def mock_formation(physical: nx.Graph, communication: nx.Graph) -> Diagram:
    """A formation on the nodes 1 … N of two graphs."""
    builder = DiagramBuilder()
    phase = builder.AddNamedSystem("phase", Block([], ["phase"], states=1))
    reference = builder.AddNamedSystem("reference", Block(["phase"], ["centre"]))
    builder.Connect(phase.get_output_port(), reference.get_input_port())
    robots = {
        i: builder.AddNamedSystem(f"robot_{i}", mock_robot(sorted(physical[i]), sorted(communication[i])))
        for i in physical
    }
    error = builder.AddNamedSystem(
        "consensus_error", Block([f"state_{i}" for i in robots], [f"error_{i}" for i in robots])
    )
    for i, robot in robots.items():
        builder.Connect(phase.get_output_port(), robot.GetInputPort("phase"))
        builder.Connect(reference.get_output_port(), robot.GetInputPort("reference"))
        builder.Connect(robot.GetOutputPort("state"), error.GetInputPort(f"state_{i}"))
        for kind, graph in (("spring", physical), ("channel", communication)):
            for j in graph[i]:
                builder.Connect(robots[j].GetOutputPort("state"), robot.GetInputPort(f"{kind}_{j}"))
        builder.ExportOutput(robot.GetOutputPort("state"), f"robot_{i}_state")
    diagram = builder.Build()
    diagram.set_name("mock")
    return diagram


def formation_wires(physical: nx.Graph, communication: nx.Graph) -> Counter:
    """The wires of :func:`mock_formation` by the names of their ports."""
    wires = Counter([("phase.phase", "reference.phase")])
    for i in physical:
        robot = f"robot_{i}"
        wires[("phase.phase", f"{robot}.phase")] += 1
        wires[("reference.centre", f"{robot}.reference")] += 1
        wires[(f"{robot}.state", f"consensus_error.state_{i}")] += 1
        wires.update((f"robot_{j}.state", f"{robot}.spring_{j}") for j in physical[i])
        wires.update((f"robot_{j}.state", f"{robot}.channel_{j}") for j in communication[i])
    return wires


def robot_wires(robot: str, held: list[int], heard: list[int]) -> Counter:
    """The wires of :func:`mock_robot`, to its border too."""
    wires = Counter([("plant.state", f"{robot}.state"), (f"{robot}.reference", "tracking.reference")])
    wires.update(("plant.state", f"{controller}.state") for controller in CONTROLLERS)
    wires.update((f"{controller}.force", f"control.u{k}") for k, controller in enumerate(CONTROLLERS))
    wires.update([("control.sum", "plant.force"), ("control.sum", f"{robot}.control_force")])
    wires.update([(f"{robot}.phase", "plant.phase"), (f"{robot}.phase", "avoidance.phase")])
    wires.update((f"{robot}.spring_{j}", f"plant.spring_{j}") for j in held)
    wires.update((f"{robot}.channel_{j}", f"consensus.channel_{j}") for j in heard)
    return wires


def drawn_wires(dot: str) -> Counter:
    return Counter((source, sink) for _, _, _, source, sink in EDGE.findall(dot))


def texts(svg: Path) -> Counter:
    return Counter(element.text for element in ET.parse(svg).iter("{http://www.w3.org/2000/svg}text"))


def complete(robots: int) -> nx.Graph:
    return nx.complete_graph(range(1, robots + 1))


@pytest.fixture(scope="module")
def pair() -> Diagram:
    return mock_formation(complete(2), complete(2))


@st.composite
def graphs(draw: st.DrawFn) -> tuple[nx.Graph, nx.Graph]:
    robots = range(1, draw(st.integers(1, 4)) + 1)
    pairs = [(i, j) for i in robots for j in robots if i < j]
    physical, communication = nx.empty_graph(robots), nx.empty_graph(robots)
    for graph in (physical, communication):
        graph.add_edges_from(pair for pair in pairs if draw(st.booleans()))
    return physical, communication


@given(graphs())
@settings(max_examples=25, deadline=None)
def test_every_wire_is_drawn_once(both: tuple[nx.Graph, nx.Graph]):
    physical, communication = both
    diagram = mock_formation(physical, communication)
    expected = formation_wires(physical, communication)
    assert drawn_wires(diagram_dot(diagram)) == expected
    for i in physical:
        expected += robot_wires(f"robot_{i}", sorted(physical[i]), sorted(communication[i]))
    assert drawn_wires(diagram_dot(diagram, depth=2)) == expected


@pytest.mark.parametrize("depth", [1, 2])
def test_every_wire_ends_at_the_port_it_is_named_after(pair: Diagram, depth: int):
    dot = diagram_dot(pair, depth)
    cells = {}
    for node, table in re.findall(r'^(".+") \[label=<(<TABLE.+)>\]$', dot, re.M):
        for port, text in re.findall(r'PORT="(\w+)"[^>]*>(?:<FONT[^>]*>)?([^<]+)<', table):
            cells[f"{node}:{port}"] = text
    for source, sink, _, source_name, sink_name in EDGE.findall(dot):
        assert cells[sink] == sink_name.rpartition(".")[2]
        if not source.endswith('"'):  # a tag has no port
            assert cells[source] == source_name.rpartition(".")[2]


@pytest.mark.parametrize("depth", [1, 2])
def test_wires_of_a_loop_between_diagrams_start_at_a_tag_with_their_source(pair: Diagram, depth: int):
    for source, _, color, name, sink in EDGE.findall(diagram_dot(pair, depth)):
        if color != SIGNAL and name.startswith("robot") and sink.startswith("robot"):
            assert source == f'"mock::{name}"'


def test_springs_and_channels_are_told_apart(pair: Diagram):
    for _, _, color, _, sink in EDGE.findall(diagram_dot(pair, depth=2)):
        kind = re.search(r"\.(spring|channel)_\d", sink)
        assert color == (WIRES[kind[1]] if kind else SIGNAL)


@pytest.mark.parametrize("depth", [1, 2])
def test_two_builds_give_the_same_text(pair: Diagram, depth: int):
    for _ in range(5):
        assert diagram_dot(mock_formation(complete(2), complete(2)), depth) == diagram_dot(pair, depth)


def test_nameless_blocks_give_the_same_text():
    def nameless() -> Diagram:
        builder = DiagramBuilder()
        builder.Connect(
            builder.AddSystem(Adder(1, 1)).get_output_port(), builder.AddSystem(Adder(1, 1)).get_input_port(0)
        )
        return builder.Build()

    first, second = nameless(), nameless()
    assert diagram_dot(first) == diagram_dot(second)


@pytest.mark.parametrize("robots", [1, 3])
def test_the_picture_shows_every_block(tmp_path: Path, robots: int):
    diagram = mock_formation(complete(robots), complete(robots))
    write_diagram(diagram, tmp_path / "shut.svg")
    write_diagram(diagram, tmp_path / "open.svg", depth=2)
    shut, opened = texts(tmp_path / "shut.svg"), texts(tmp_path / "open.svg")
    outer = {"mock", "consensus_error", *(f"robot_{i}" for i in range(1, robots + 1))}
    assert all(shut[name] == opened[name] == 1 for name in outer)
    assert all(shut[name] == 0 and opened[name] == robots for name in ("plant", "tracking", "control", "avoidance"))
    assert shut["Diagram"] == robots
    assert opened["Adder"] == robots


def test_one_robot_is_drawn_with_its_border(pair: Diagram, tmp_path: Path):
    robot = pair.GetSubsystemByName("robot_1")
    assert drawn_wires(diagram_dot(robot)) == robot_wires("robot_1", [2], [2])
    write_diagram(robot, tmp_path / "robot.svg")
    assert texts(tmp_path / "robot.svg")["control_force"] == 1


def test_names_may_hold_any_character(tmp_path: Path):
    builder = DiagramBuilder()
    name = 'a <b> & "c" \\'
    builder.AddNamedSystem(name, Block([name], ["δ"]))
    diagram = builder.Build()
    write_diagram(diagram, tmp_path / "odd.svg")
    assert texts(tmp_path / "odd.svg") >= Counter({name: 2, "δ": 1})
    with pytest.raises(ValueError, match="δ"):
        write_diagram(diagram, tmp_path / "odd.pdf")


@pytest.mark.parametrize(
    ("suffix", "magic"), [("dot", b"digraph {"), ("svg", b"<?xml"), ("png", b"\x89PNG\r\n"), ("pdf", b"%PDF-")]
)
def test_every_format_is_written(pair: Diagram, tmp_path: Path, suffix: str, magic: bytes):
    path = tmp_path / f"pair.{suffix}"
    write_diagram(pair, path, depth=2)
    assert path.read_bytes().startswith(magic)
    assert path.stat().st_size > 2000


def test_a_png_is_twice_as_fine_as_a_screen(pair: Diagram, tmp_path: Path):
    write_diagram(pair, tmp_path / "pair.svg")
    write_diagram(pair, tmp_path / "pair.png")
    points = float(ET.parse(tmp_path / "pair.svg").getroot().attrib["width"].removesuffix("pt"))
    pixels = int.from_bytes((tmp_path / "pair.png").read_bytes()[16:20])
    assert pixels == pytest.approx(points * 2 * 96 / 72, abs=4)


def test_another_suffix_is_refused(tmp_path: Path):
    with pytest.raises(ValueError, match=r"\.dot, \.svg, \.png, \.pdf"):
        render("digraph {}", tmp_path / "diagram.jpg")


def test_a_missing_folder_is_named(tmp_path: Path):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        render("digraph {}", tmp_path / "nowhere" / "diagram.svg")


def test_text_that_is_not_graphviz_is_refused(tmp_path: Path):
    with pytest.raises(ValueError, match="syntax error"):
        render("digraph {", tmp_path / "diagram.svg")


def test_depth_zero_is_refused(pair: Diagram):
    with pytest.raises(ValueError, match="depth of 0"):
        diagram_dot(pair, depth=0)
