"""A scenario as HTML: its formation, its world, and what of it is not as by default."""

from collections.abc import Iterator
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel
from pydantic_core import PydanticUndefined

from drake_formation.config.errors import ScenarioError
from drake_formation.display.graph import drawing
from drake_formation.display.markup import QUIET, element, html, table
from drake_formation.display.plane import Plane
from drake_formation.formation.formation import Formation
from drake_formation.scenario.resolve import resolve
from drake_formation.scenario.schema import Scenario

Array = NDArray[np.float64]

WIDTH, HEIGHT = 640.0, 220.0
"""Of the world at the most (px)."""

LONGEST = 100
"""Characters of a value that are shown."""

OBSTACLE, RANGE = "#555", "#e69f00"
"""Colours."""


def scenario_html(scenario: Scenario) -> str:
    """A scenario for a notebook; of one that is wrong, what is wrong instead of pictures."""
    heading = element("div", element("b", scenario.name), f" {scenario.description}")
    try:
        shown = _pictures(resolve(scenario))
    except ScenarioError as error:
        shown = element("pre", str(error))
    note = element("div", "What is not listed is as by default.", style=QUIET)
    return html(element("div", heading, shown, table(not_default(scenario)), note))


def _pictures(formation: Formation) -> Element:
    """The formation, and beside it its world."""
    pictures = element("div", style="display: flex; flex-wrap: wrap; gap: 16px; align-items: center")
    springs = [] if formation.has_body else [(i, j) for i, j in formation.springs.pairs.tolist()]
    channels = [(i, j) for i, j in formation.channels.pairs.tolist()]
    pictures.append(drawing(formation.slots, springs=springs, channels=channels).svg)
    pictures.append(world(formation).svg)
    return pictures


def not_default(section: BaseModel, path: str = "") -> Iterator[tuple[str, str, str]]:
    """What differs from its default: path, value and meaning, in the order of the schema."""
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        if path + name in ("name", "description") or value == field.get_default(call_default_factory=True):
            continue
        if isinstance(value, BaseModel):
            yield from not_default(value, f"{path}{name}.")
        else:
            yield f"{path}{name}", _shortened(written(value)), (field.description or "").partition(";")[0]


def written(value: Any) -> str:
    """A value as YAML has it on one line, without what is as by default."""
    if isinstance(value, BaseModel):
        given = {name: getattr(value, name) for name in type(value).model_fields}
        fields = type(value).model_fields
        default = {name: fields[name].get_default(call_default_factory=True) for name in given}
        return written({n: v for n, v in given.items() if default[n] is PydanticUndefined or v != default[n]})
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {written(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(written, value)) + "]"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _shortened(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def world(formation: Formation) -> Plane:
    """Where robots start and are to come to rest, and obstacles with the range at which they are felt."""
    goal = formation.goal + formation.slots
    plane = Plane(*surroundings(formation, [formation.starts, goal]), WIDTH, HEIGHT)
    draw_obstacles(plane, formation)
    plane.line(np.array([formation.centre, formation.goal]), stroke="#bbb", stroke_dasharray="2 4")
    for start, end in zip(formation.starts, goal, strict=True):
        plane.dot(start, 3.5, fill="none", stroke="#0072b2")
        plane.cross(end, 3.0, stroke="#d55e00")
    return plane


def surroundings(formation: Formation, places: list[Array]) -> tuple[Array, Array]:
    """Corners of a rectangle about some places, and about all obstacles with their range where they are at first."""
    corners = [place.reshape(-1, 2) for place in places]
    for obstacle in formation.obstacles:
        grown = obstacle.radius + formation.felt_within
        corners += [obstacle.vertices - grown, obstacle.vertices + grown]
    everything = np.concatenate(corners)
    return everything.min(axis=0), everything.max(axis=0)


def draw_obstacles(plane: Plane, formation: Formation) -> None:
    """Obstacles where they are before they move, with their range dashed."""
    from drake_formation.viz.obstacles import grown_outline  # with Matplotlib, which is slow to import

    reach = formation.felt_within
    for obstacle in formation.obstacles:
        if len(obstacle.vertices) == 1:
            (middle,) = obstacle.vertices
            plane.dot(middle, max(3.0, plane.scale * obstacle.radius), fill=OBSTACLE)
            plane.dot(middle, plane.scale * (obstacle.radius + reach), fill="none", **_dashed(reach))
        else:
            plane.area(grown_outline(obstacle.vertices, obstacle.radius), fill=OBSTACLE)
            plane.area(grown_outline(obstacle.vertices, obstacle.radius + reach), fill="none", **_dashed(reach))


def _dashed(reach: float) -> dict[str, object]:
    return {"stroke": RANGE if reach else "none", "stroke_dasharray": "4 3"}
