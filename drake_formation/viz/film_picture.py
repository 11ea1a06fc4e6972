"""One picture of a film after the other, in the same figure."""

from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray

from drake_formation.viz.figures import robot_colours
from drake_formation.viz.film_marks import FilmMarks
from drake_formation.viz.film_talk import FilmTalk
from drake_formation.viz.links import largest_strain, moving_links, present, strain_colour, strains
from drake_formation.viz.obstacles import OBSTACLE_COLOUR, draw_obstacles, grown
from drake_formation.viz.outline import rigid_outline
from drake_formation.viz.playback import Playback

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

WIDTH, LOWEST, HIGHEST = 9.0, 2.5, 9.0
"""Of a picture (inches)."""

MARGIN = 0.6
"""Around all that is seen (m)."""


class FilmPicture:
    """Robots where they are and have been, the object, obstacles, channels with their packets, and what happened.

    Args:
        result: what is shown.
        playback: of that result.
        times: of the pictures (s), shape (pictures,).
        follow: keep the formation in the middle; otherwise all is seen.

    Attributes:
        figure: in which they are drawn.
    """

    def __init__(self, result: "xr.Dataset", playback: Playback, times: Array, *, follow: bool = False) -> None:
        self._title, self._times = playback.title, times
        self._points, self._carried = playback.points(times), playback.carried(times)
        self._springs = [link for link in moving_links(playback) if link.rest_length is not None]
        self._shares = strains(self._springs, self._points) / largest_strain(playback, self._springs)
        self._present, self._moved = present(playback, self._springs, times), playback.moved(times)
        self.figure = Figure(layout="constrained")
        self._axes = self.figure.subplots()
        self._windows = _windows(playback, self._points, follow=follow)
        scale = _fit(self.figure, self._axes, self._windows[0])
        moves = [len(obstacle.motion) > 0 for obstacle in playback.formation.obstacles]
        draw_obstacles(self._axes, result.isel(obstacle=~np.array(moves, dtype=bool)), [])
        self._obstacles = {k: self._draw_moving(playback, k) for k in np.flatnonzero(moves).tolist()}
        self._draw_goal(playback, robot_colours(result))
        self._make_moving(playback, robot_colours(result))
        self._talk, self._marks = FilmTalk(self._axes, playback, times, scale), FilmMarks(self._axes, playback, times)
        self._told = self._axes.text(0.01, 0.02, "", transform=self._axes.transAxes, fontsize="small", zorder=7)
        self.show(0)
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")  # once for all pictures

    def show(self, number: int) -> list[Artist]:
        """Draw one of the pictures, from 0; gives what has changed."""
        points = self._points[number]
        (left, bottom), (right, top) = self._windows[number]
        self._axes.set(xlim=(left, right), ylim=(bottom, top))
        for i, (trail, dot) in enumerate(zip(self._trails, self._dots, strict=True)):
            trail.set_data(*self._points[: number + 1, i].T)
            dot.set_data(*points[i : i + 1].T)
        seen = np.flatnonzero(self._present[number]).tolist()
        ends = [points[[self._springs[k].start, self._springs[k].end]] for k in seen]
        self._lines.set_segments(ends)
        self._lines.set_color([strain_colour(self._shares[number, k]) for k in seen] or "none")
        if self._body is not None:
            x, y, heading = self._poses[number]
            c, s = np.cos(heading), np.sin(heading)
            self._body.set_xy(self._outline @ np.array([[c, s], [-s, c]]) + [x, y])
        for k, patches in self._obstacles.items():
            there = Affine2D().translate(*self._moved[number, k]) + self._axes.transData
            for patch in patches:
                patch.set_transform(there)
        phase = "carrying" if self._carried[number] else "gathering"
        self._axes.set_title(f"{self._title}: {phase}, {self._times[number]:.1f} s")
        self._told.set_text(self._marks.told(number))
        layers = [artist for layer in (self._talk, self._marks) for artist in layer.show(number, points)]
        body = [] if self._body is None else [self._body]
        obstacles = chain(*self._obstacles.values())
        return [*self._trails, *self._dots, self._lines, *body, *obstacles, *layers, self._told, self._axes.title]

    def _draw_moving(self, playback: Playback, number: int) -> list[Patch]:
        """An obstacle that moves, and over which robots sense it, where it is at first."""
        obstacle, reach = playback.formation.obstacles.items[number], playback.sensing_range
        patches = [grown(obstacle.vertices, obstacle.radius, color=OBSTACLE_COLOUR, alpha=0.5)]
        if reach:
            dashed: dict[str, Any] = {"fill": False, "linestyle": "--", "edgecolor": "0.5"}
            patches.append(grown(obstacle.vertices, obstacle.radius + reach, **dashed))
        for patch in patches:
            self._axes.add_patch(patch)
        return patches

    def _draw_goal(self, playback: Playback, colours: dict[int, Any]) -> None:
        places = playback.formation.goal + playback.formation.slots
        x, y = places.T
        self._axes.scatter(x, y, s=40.0, marker="x", color=list(colours.values()), linewidths=1.2)

    def _make_moving(self, playback: Playback, colours: dict[int, Any]) -> None:
        """Everything that moves, still nowhere."""
        self._outline, self._poses, self._body = np.zeros((0, 2)), np.zeros((0, 3)), None
        if playback.formation.has_body and not playback.nodes:
            self._outline, self._poses = rigid_outline(playback.formation), playback.body(self._times)
            (self._body,) = self._axes.fill([], [], color="tan", alpha=0.6, zorder=1)
        self._lines = LineCollection([], linewidths=2.0, zorder=2)
        self._axes.add_collection(self._lines)
        look: dict[str, Any] = {"markersize": 7, "markeredgecolor": "white", "zorder": 3}
        self._trails = [self._axes.plot([], [], color=colour, linewidth=1.0)[0] for colour in colours.values()]
        self._dots = [self._axes.plot([], [], "o", color=colour, **look)[0] for colour in colours.values()]


def _windows(playback: Playback, points: Array, *, follow: bool) -> Array:
    """What each picture shows: its left lower and right upper corner (m), shape (pictures, 2, 2), all of one size."""
    low, high = playback.seen(points)
    if not follow:
        return np.broadcast_to([low - MARGIN, high + MARGIN], (len(points), 2, 2))
    robots = points[:, : playback.formation.robots]
    middles = robots.mean(axis=1)
    reach = np.array([2.0, 1.0]) * (MARGIN + max(playback.formation.radius, float(np.ptp(robots[0], axis=0).max()) / 2))
    return np.stack([middles - reach, middles + reach], axis=1)


def _fit(figure: Figure, axes: Axes, window: Array) -> float:
    """One scale in all pictures, and a figure of the shape of what is seen; gives points (1/72 in) a metre."""
    (left, bottom), (right, top) = window
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xlabel="x (m)", ylabel="y (m)")
    axes.grid(alpha=0.3)
    figure.set_size_inches(WIDTH, min(max(0.9 * WIDTH * (top - bottom) / (right - left) + 0.8, LOWEST), HIGHEST))
    return float(72 * 0.9 * WIDTH / (right - left))
