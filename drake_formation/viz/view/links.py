"""What is stretched between points that move: springs and channels.

SceneGraph moves shapes, but does not stretch them. So each link is an object of Meshcat's own, one metre long, that is
placed, turned, stretched and coloured.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydrake.common.eigen_geometry import Quaternion
from pydrake.geometry import Cylinder, Meshcat, MeshcatCone, Rgba
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, LeafSystem

from drake_formation.formation.formation import Formation
from drake_formation.viz.view.solids import TALKING_HEIGHT, Colour

Array = NDArray[np.float64]

SPRING_RADIUS, NEEDLE_RADIUS = 0.025, 0.03
SHORTEST = 1e-3
"""A link is drawn at least as long (m): what has no length has no direction."""

PRESSED, AT_REST, STRETCHED = np.array([[0.13, 0.40, 0.75], [0.72, 0.72, 0.72], [0.84, 0.19, 0.05]])
"""Colours of a spring's strain, which all eyes tell apart."""
CHANNEL: Colour = (0.0, 0.62, 0.45, 0.55)


@dataclass(frozen=True)
class Link:
    """A line between two of the points.

    Attributes:
        path: in Meshcat.
        start: index of the point where it begins.
        end: index of the point where it ends.
        height: above the ground (m).
        rest_length: of a spring, which is coloured by its strain (m); None for a channel.
    """

    path: str
    start: int
    end: int
    height: float
    rest_length: float | None = None


def channel_links(formation: Formation) -> list[Link]:
    """Who hears whom: a needle from the robot that speaks to a point at the one that hears."""
    return [
        Link(f"channels/{speaker + 1} to {listener + 1}", speaker, listener, TALKING_HEIGHT)
        for listener, speaker in formation.channels.pairs.tolist()
    ]


def lengths(links: Sequence[Link], points: Array) -> Array:
    """Length d of every link (m), shape (…, links), between points of shape (…, points, 2)."""
    start, end = [link.start for link in links], [link.end for link in links]
    result: Array = np.linalg.norm(points[..., end, :] - points[..., start, :], axis=-1)
    return result


def strains(links: Sequence[Link], points: Array) -> Array:
    """d/r − 1 of every link (1), zero for channels; shapes as for :func:`lengths`."""
    rest = np.array([link.rest_length or np.inf for link in links])
    result: Array = np.where(np.isfinite(rest), lengths(links, points) / rest - 1.0, 0.0)
    return result


def strain_colour(share: float) -> list[float]:
    """Red, green and blue of a strain, as a share of the largest one shown: from −1, pressed, to 1, stretched."""
    far = STRETCHED if share > 0 else PRESSED
    colour: list[float] = (AT_REST + min(abs(share), 1.0) * (far - AT_REST)).tolist()
    return colour


class LinkDrawer(LeafSystem):  # type: ignore[misc]
    """Draws links into the recording whenever it is published.

    Their colour is three.js' own property, which Meshcat takes in recordings alone.

    Input ports: ``points`` (m), x and y of each; ``shown``, for every link 1 if it is to be seen, else 0.

    Args:
        meshcat: where.
        root: path of all links.
        links: what to draw.
        points: how many points there are.
        largest: the strain that is drawn in full colour (1).
    """

    def __init__(self, meshcat: Meshcat, root: str, links: Sequence[Link], points: int, largest: float) -> None:
        super().__init__()
        self._meshcat, self._root, self._links, self._largest = meshcat, root, links, largest
        self._points = self.DeclareVectorInputPort("points", 2 * points)
        self._shown = self.DeclareVectorInputPort("shown", len(links))
        self.DeclareForcedPublishEvent(self._draw)
        for link in links:
            self._make(link)

    def _make(self, link: Link) -> None:
        body = f"{self._root}/{link.path}/body"
        if link.rest_length is None:
            # A cone stands on its tip, which goes to the end of the link, and opens along z.
            self._meshcat.SetObject(body, MeshcatCone(1.0, NEEDLE_RADIUS, NEEDLE_RADIUS), Rgba(*CHANNEL))
            pose = RigidTransform(RotationMatrix.MakeYRotation(-np.pi / 2), [0.5, 0, 0])
        else:
            self._meshcat.SetObject(body, Cylinder(SPRING_RADIUS, 1.0), Rgba(*AT_REST))
            pose = RigidTransform(RotationMatrix.MakeYRotation(np.pi / 2), [0, 0, 0])
        self._meshcat.SetTransform(body, pose)

    def _draw(self, context: Context) -> None:
        time = context.get_time()
        points = self._points.Eval(context).reshape(-1, 2)
        shown = self._shown.Eval(context)
        for link, seen, strain in zip(self._links, shown, strains(self._links, points), strict=True):
            path = f"{self._root}/{link.path}"
            (x, y), (dx, dy) = points[link.start], points[link.end] - points[link.start]
            length = max(float(np.hypot(dx, dy)), SHORTEST)
            half = 0.5 * np.arctan2(dy, dx)
            turned = Quaternion(np.cos(half), 0.0, 0.0, np.sin(half))
            middle = [x + dx / 2, y + dy / 2, link.height]
            self._meshcat.SetTransform(path, RigidTransform(turned, middle), time)
            self._meshcat.SetProperty(path, "scale", [length, 1.0, 1.0], time)
            self._meshcat.SetProperty(path, "visible", bool(seen), time)
            if link.rest_length is not None:
                colour = strain_colour(strain / self._largest)
                self._meshcat.SetProperty(f"{path}/body/<object>", "material.color", colour, time)
