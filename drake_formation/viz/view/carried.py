"""What the carried object looks like: springs between robots, a rigid plate, or a grid of springs."""

from collections.abc import Iterator

import numpy as np
from pydrake.geometry import Convex

from drake_formation.formation.formation import Formation
from drake_formation.viz.view.links import Link
from drake_formation.viz.view.solids import CARRYING_HEIGHT, Solid

RIM = 0.12
"""How far a rigid object reaches beyond its grips (m)."""

THICKNESS = 0.05
"""Of a rigid object (m)."""


def object_solids(formation: Formation) -> Iterator[Solid]:
    """A rigid object in its own frame: a plate over its grips, which are at the slots."""
    around = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
    rim = RIM * np.stack([np.cos(around), np.sin(around)], axis=-1)
    outline = (formation.slots[:, None] + rim).reshape(-1, 2)
    levels = (CARRYING_HEIGHT, CARRYING_HEIGHT + THICKNESS)
    corners = np.concatenate([np.column_stack([outline, np.full(len(outline), z)]) for z in levels])
    yield Solid(Convex(corners.T, "object"), colour=(0.85, 0.75, 0.55, 0.85))


def spring_links(formation: Formation) -> list[Link]:
    """The springs between robots, which are the points 0 … N-1."""
    pairs = formation.springs.pairs.tolist()
    return [
        Link(f"springs/{i + 1}-{j + 1}", i, j, CARRYING_HEIGHT, rest_length=float(rest))
        for (i, j), rest in zip(pairs, formation.rest_lengths, strict=True)
    ]


def grid_links(formation: Formation) -> list[Link]:
    """The springs of a plate along its rows and columns; its nodes are the points after the robots."""
    config = formation.parts["object"][0].config
    slots, shape = formation.slots, (config.rows, config.columns)
    width, height = np.ptp(slots, axis=0) / np.maximum([config.columns - 1, config.rows - 1], 1)
    index = formation.robots + np.arange(config.rows * config.columns).reshape(shape)
    runs = [(index[:, :-1], index[:, 1:], width), (index[:-1], index[1:], height)]
    return [
        Link(f"object/{i - formation.robots + 1}-{j - formation.robots + 1}", i, j, CARRYING_HEIGHT, float(rest))
        for starts, ends, rest in runs
        for i, j in zip(starts.ravel().tolist(), ends.ravel().tolist(), strict=True)
    ]
