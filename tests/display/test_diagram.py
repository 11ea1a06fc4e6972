"""IPython shows Drake's diagrams, wherever they are from."""

from xml.etree.ElementTree import fromstring

import pytest
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource
from shown import Shown

from drake_formation import build_diagram, load_scenario
from drake_formation.display.diagram import show_diagrams


@pytest.fixture
def shell(tmp_path, monkeypatch):
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    from IPython.core.interactiveshell import InteractiveShell

    yield InteractiveShell.instance()
    InteractiveShell.clear_instance()


def drawn(shell, diagram):
    data, _ = shell.display_formatter.format(diagram)
    return data.get("image/svg+xml")


def test_a_diagram_is_a_picture_of_its_blocks(shell):
    diagram = build_diagram(load_scenario("line"))
    assert drawn(shell, diagram) is None
    show_diagrams()
    picture = drawn(shell, diagram)
    assert fromstring(picture).tag.endswith("svg")  # notebooks take it as a file of its own
    shown = Shown(picture)
    assert {"robot_1", "robot_2", "phase"} <= set(shown.texts)
    assert "plant" in Shown(drawn(shell, diagram.GetSubsystemByName("robot_1"))).texts


def test_a_large_formation_is_shown_at_a_glance(shell):
    show_diagrams()
    texts = Shown(drawn(shell, build_diagram(load_scenario("octagon")))).texts
    assert {"1", "8"} <= set(texts)
    assert "plant" in texts  # of the one that is opened


def test_any_diagram_is_drawn_and_its_names_are_text(shell):
    show_diagrams()
    builder = DiagramBuilder()
    builder.AddNamedSystem("<script>alert(1)</script>", ConstantVectorSource([1.0]))
    diagram = builder.Build()
    diagram.set_name("<script>alert(2)</script>")
    shown = Shown(drawn(shell, diagram))
    assert not shown.runs
    assert "<script>alert(1)</script>" in shown.text


def test_what_the_user_chose_before_is_kept(shell):
    from pydrake.systems.framework import Diagram

    formatter = shell.display_formatter.formatters["image/svg+xml"]
    formatter.for_type(Diagram, lambda _: "<svg>mine</svg>")
    show_diagrams()
    assert drawn(shell, build_diagram(load_scenario("line"))) == "<svg>mine</svg>"
