"""What is seen of a result in three dimensions: bodies in frames that move, and lines between points that move."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drake_formation.exporting.shapes import Piece, pieces
from drake_formation.viz.figures import robot_colours
from drake_formation.viz.links import Link, alive, largest_strain, moving_links, present, strain_colour, strains
from drake_formation.viz.playback import Playback
from drake_formation.viz.view.carried import object_solids
from drake_formation.viz.view.link_drawer import CHANNEL, SILENT
from drake_formation.viz.view.obstacles import obstacle_solids
from drake_formation.viz.view.robots import solids_of
from drake_formation.viz.view.solids import CARRYING_HEIGHT, TALKING_HEIGHT, Colour
from drake_formation.viz.view.stage import goal

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

RATE = 20.0
"""Pictures a second."""

WORLD = "world"
"""The frame that is at rest."""


@dataclass(frozen=True)
class Lines:
    """Lines at one time.

    Attributes:
        ends: where each begins and ends (m), shape (lines, 2, 3).
        colours: of each, red, green, blue and how opaque, shape (lines, 4).
    """

    ends: Array
    colours: Array


class Scene:
    """A result as bodies and lines, as :mod:`drake_formation.viz.view` shows it.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.

    Attributes:
        playback: the result between its samples.
        times: of the pictures, 20 a second and the last (s), shape (pictures,).

    Raises:
        ValueError, ScenarioError: as for :class:`drake_formation.viz.playback.Playback`.
    """

    def __init__(self, result: "xr.Dataset") -> None:
        self.playback = playback = Playback(result)
        count = int(np.floor((playback.end - playback.begin) * RATE)) + 1
        self.times = np.unique([*(playback.begin + np.arange(count) / RATE), playback.end])
        self.colours: dict[int, Colour] = {i: (r, g, b, 1.0) for i, (r, g, b, *_) in robot_colours(result).items()}
        self._links = moving_links(playback)

    def bodies(self) -> Iterator[tuple[str, str, list[Piece]]]:
        """Everything solid: what it is called, the frame that it is fixed to, and its pieces."""
        playback, formation = self.playback, self.playback.formation
        for i, (robot, colour) in enumerate(self.colours.items()):
            yield f"robot_{robot}", f"robot_{robot}", list(pieces(solids_of(formation, i), colour))
            yield f"goal_{robot}", WORLD, list(pieces([goal(playback, i)], (*colour[:3], 0.5)))
        if self._has_rigid_object:
            yield "object", "object", list(pieces(object_solids(formation)))
        for k, obstacle in enumerate(formation.obstacles):
            name = f"obstacle_{k + 1}"
            solids = obstacle_solids(obstacle, playback.sensing_range)
            yield name, name if len(obstacle.motion) else WORLD, list(pieces(solids))

    @cached_property
    def frames(self) -> dict[str, Array]:
        """Place (m) and heading (rad) of every frame that moves, by its name, at all times: shape (pictures, 3)."""
        playback, times = self.playback, self.times
        places, headings = playback.positions(times), playback.headings(times)
        found = {f"robot_{i}": np.column_stack([places[:, k], headings[:, k]]) for k, i in enumerate(self.colours)}
        if self._has_rigid_object:
            found["object"] = playback.body(times)
        moved = playback.moved(times)
        for k, obstacle in enumerate(playback.formation.obstacles):
            if len(obstacle.motion):
                found[f"obstacle_{k + 1}"] = np.column_stack([moved[:, k], np.zeros(len(times))])
        return found

    @cached_property
    def paths(self) -> dict[int, Array]:
        """Where every robot goes (m), by its number, on the ground: shape (pictures, 3)."""
        flat = np.zeros((len(self.times), 1))
        return {i: np.hstack([self.frames[f"robot_{i}"][:, :2], flat]) for i in self.colours}

    def lines(self) -> Iterator[tuple[str, list[Lines]]]:
        """Springs and channels at all times, those that are there: what they are called, and a picture after another.

        Springs have the colour of their strain; a channel over which nothing new is heard is grey.
        """
        springs = [link for link in self._links if link.rest_length is not None]
        channels = [link for link in self._links if link.rest_length is None]
        largest = largest_strain(self.playback, springs)
        if springs:
            shares = strains(springs, self._points) / largest
            colours = np.array([[(*strain_colour(share), 1.0) for share in row] for row in shares.tolist()])
            yield "springs", self._between(springs, CARRYING_HEIGHT, colours)
        if channels:
            told = alive(self.playback, channels, self.times)
            spoken, silent = np.array(CHANNEL), np.array([*SILENT, CHANNEL[3]])
            yield "channels", self._between(channels, TALKING_HEIGHT, np.where(told[..., None], spoken, silent))

    @cached_property
    def _points(self) -> Array:
        return self.playback.points(self.times)

    @property
    def _has_rigid_object(self) -> bool:
        return self.playback.formation.has_body and not self.playback.nodes

    def _between(self, links: list[Link], height: float, colours: Array) -> list[Lines]:
        ends = self._points[:, [[link.start, link.end] for link in links]]
        ends = np.concatenate([ends, np.full((*ends.shape[:-1], 1), height)], axis=-1)
        seen = present(self.playback, links, self.times)
        return [Lines(*picture) for picture in ((ends[k][seen[k]], colours[k][seen[k]]) for k in range(len(ends)))]
