"""What is stretched between points that move, drawn in Meshcat.

SceneGraph moves shapes, but does not stretch them. So each link is an object of Meshcat's own, one metre long, that is
placed, turned, stretched and coloured.
"""

from collections.abc import Sequence

import numpy as np
from pydrake.common.eigen_geometry import Quaternion
from pydrake.geometry import Cylinder, Meshcat, MeshcatCone, Rgba
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, LeafSystem

from drake_formation.viz import palette
from drake_formation.viz.links import AT_REST, Link, strain_colour, strains
from drake_formation.viz.view.solids import CARRYING_HEIGHT, TALKING_HEIGHT, Colour, opaque

SPRING_RADIUS, NEEDLE_RADIUS = 0.025, 0.03
SHORTEST = 1e-3
"""A link is drawn at least as long (m): what has no length has no direction."""

CHANNEL: Colour = opaque(palette.CHANNEL, 0.55)
SILENT, THIN = opaque(palette.SILENT)[:3], 0.3
"""Colour of a channel over which nothing new is heard, and its width as a share of others'."""


class LinkDrawer(LeafSystem):  # type: ignore[misc]
    """Draws links into the recording whenever it is published.

    Their colour is three.js' own property, which Meshcat takes in recordings alone.

    Input ports: ``points`` (m), x and y of each; ``shown``, for every link 1 if it is to be seen, else 0; ``alive``,
    likewise 0 for a channel that is silent.

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
        self._alive = self.DeclareVectorInputPort("alive", len(links))
        self.DeclareForcedPublishEvent(self._draw)
        for link in links:
            self._make(link)

    def _make(self, link: Link) -> None:
        body = f"{self._root}/{link.name}/body"
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
        told = self._shown.Eval(context), self._alive.Eval(context), strains(self._links, points)
        for link, seen, alive, strain in zip(self._links, *told, strict=True):
            path = f"{self._root}/{link.name}"
            (x, y), (dx, dy) = points[link.start], points[link.end] - points[link.start]
            height = TALKING_HEIGHT if link.rest_length is None else CARRYING_HEIGHT
            length = max(float(np.hypot(dx, dy)), SHORTEST)
            half = 0.5 * np.arctan2(dy, dx)
            turned = Quaternion(np.cos(half), 0.0, 0.0, np.sin(half))
            middle = [x + dx / 2, y + dy / 2, height]
            self._meshcat.SetTransform(path, RigidTransform(turned, middle), time)
            width = 1.0 if alive else THIN
            self._meshcat.SetProperty(path, "scale", [length, width, width], time)
            self._meshcat.SetProperty(path, "visible", bool(seen), time)
            if link.rest_length is not None:
                self._colour(path, strain_colour(strain / self._largest), time)
            elif link.mortal is not None:
                self._colour(path, CHANNEL[:3] if alive else SILENT, time)

    def _colour(self, path: str, colour: tuple[float, float, float], time: float) -> None:
        self._meshcat.SetProperty(f"{path}/body/<object>", "material.color", list(colour), time)
