"""Small drawings in the plane, in metres, as SVG."""

from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from drake_formation.display.markup import element

Array = NDArray[np.float64]

RIM = 14.0
"""Around all that is drawn (px)."""


class Plane:
    """A drawing of a rectangle of the world, y upward.

    Args:
        low: its lower left corner (m).
        high: its upper right corner (m).
        width, height: at most so large (px).

    Attributes:
        scale: pixels a metre.
        svg: the drawing.
    """

    def __init__(self, low: Array, high: Array, width: float, height: float) -> None:
        extent = np.maximum(high - low, 1e-9)
        self.scale = float(min((width - 2 * RIM) / extent[0], (height - 2 * RIM) / extent[1]))
        self._low, self._high = low, high
        across, up = (self.scale * (high - low) + 2 * RIM).tolist()
        self.svg: Element = element(
            "svg",
            xmlns="http://www.w3.org/2000/svg",
            viewBox=f"0 0 {across:.1f} {up:.1f}",
            width=f"{across:.0f}",
            height=f"{up:.0f}",
            style="max-width: 100%; height: auto; background: white",
        )

    def pixels(self, places: Array) -> Array:
        """Where places are drawn (px), of the same shape (…, 2)."""
        x = RIM + self.scale * (places[..., 0] - self._low[0])
        y = RIM + self.scale * (self._high[1] - places[..., 1])
        return np.stack([x, y], axis=-1)

    def dot(self, place: Array, radius: float, **look: object) -> None:
        """A disk about a place (m), of a radius in pixels."""
        x, y = self.pixels(place).tolist()
        self.svg.append(element("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r=f"{radius:.1f}", **look))

    def line(self, points: Array, **look: object) -> None:
        """A line through places (m), shape (n, 2)."""
        self.svg.append(element("polyline", points=self._listed(points), fill="none", **look))

    def area(self, corners: Array, **look: object) -> None:
        """The inside of a polygon (m), shape (n, 2)."""
        self.svg.append(element("polygon", points=self._listed(corners), **look))

    def cross(self, place: Array, reach: float, **look: object) -> None:
        """A cross at a place (m), whose arms are so long (px)."""
        for way in (1.0, -1.0):
            arm = np.array([reach, way * reach]) / self.scale
            self.line(np.array([place - arm, place + arm]), **look)

    def word(self, place: Array, text: str, size: float, **look: object) -> None:
        """A word in the middle of a place (m)."""
        x, y = self.pixels(place).tolist()
        where = {"x": f"{x:.1f}", "y": f"{y + 0.35 * size:.1f}", "font_size": f"{size:.0f}"}
        self.svg.append(element("text", text, **where, text_anchor="middle", font_family="sans-serif", **look))

    def _listed(self, places: Array) -> str:
        return " ".join(f"{x:.1f},{y:.1f}" for x, y in self.pixels(places).tolist())
