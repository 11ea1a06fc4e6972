"""A scenario drawn before it runs shows what is in it."""

import numpy as np
import pytest
from matplotlib.patches import FancyArrowPatch

from drake_formation.scenario import load_scenario, resolve
from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate
from drake_formation.viz.sketch import sketch
from drake_formation.viz.style import draw


def drawn(name, **overrides):
    formation = resolve(load_scenario(name, overrides=overrides))
    return formation, sketch(formation)


def places(axes, marker):
    return np.array(
        [line.get_xydata()[0] for line in axes.lines if line.get_marker() == marker and len(line.get_xdata())]
    )


def test_robots_are_at_their_starts_and_slots_and_at_the_goal():
    formation, figure = drawn("line")
    plan = figure.axes[0]
    np.testing.assert_allclose(places(plan, "s"), formation.starts)
    slots = places(plan, "o").reshape(-1, 2, 2)
    np.testing.assert_allclose(slots[:, 0], formation.centre + formation.slots)
    np.testing.assert_allclose(slots[:, 1], formation.goal + formation.slots)


def test_there_is_an_arrow_a_channel_and_a_line_a_spring():
    formation, figure = drawn("quadrilateral", **{"consensus.graph": [{"speaker": 2, "listener": 1}, [2, 3]]})
    links = figure.axes[1]
    arrows = [patch for patch in links.patches if isinstance(patch, FancyArrowPatch)]
    assert len(arrows) == len(formation.channels.pairs) == 3
    assert len(links.collections[0].get_segments()) == 6


def test_obstacles_are_as_large_as_they_are_with_the_range_around():
    _, figure = drawn("line", **{"avoidance.obstacles": [{"position": [6.0, 5.0], "radius": 0.2}]})
    assert [patch.radius for patch in figure.axes[0].patches] == pytest.approx([0.2, 0.2 + 1.3])


BODY = """
name: body
formation: {shape: polygon, robots: 3, side: 1.0}
robots: {start: {centre: [0.0, 0.0]}, radius: 0.2}
object: {kind: rigid}
avoidance:
  obstacles:
    - {kind: segment, ends: [[3.0, 2.0], [4.0, 2.0]], velocity: [0.0, -0.1], start: 2.0}
transport: {goal: [5.0, 0.0], duration: 10.0}
"""


def test_bodies_and_moving_obstacles_are_drawn(tmp_path):
    formation = resolve(validate(parse(BODY, "body.yaml")))
    figure = sketch(formation)
    (way,) = [line for line in figure.axes[0].lines if line.get_linestyle() == "-."]
    np.testing.assert_allclose(way.get_xydata(), [[3.5, 2.0], [3.5, 1.2]])
    assert "object" in [text.get_text() for text in figure.legends[0].get_texts()]
    for suffix in ("png", "svg", "pdf"):
        draw(lambda: sketch(formation), tmp_path / f"body.{suffix}")
