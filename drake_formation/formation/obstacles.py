"""The obstacles of a formation: points, segments and polygons, grown by a radius, at rest or moving."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.systems.outlines import ROUND, Layout, offsets
from drake_formation.vectors import length_of

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Obstacle:
    """All points within a radius of a point, a segment or a polygon with its inside.

    Attributes:
        vertices: the centre of a circle, the ends of a segment, or the corners of a polygon, counter-clockwise; where
            they are before it moves (m), shape (vertices, 2).
        radius: by how much that is grown all round (m).
        known: whether planners know it.
        motion: of each piece of its motion when it begins and ends (s) and the velocity (m/s), shape (pieces, 4).
    """

    vertices: Array
    radius: float = 0.0
    known: bool = True
    motion: Array = field(default_factory=lambda: np.zeros((0, 4)))

    @property
    def layout(self) -> tuple[int, int]:
        """The number of its vertices and of the pieces of its motion."""
        return len(self.vertices), len(self.motion)

    @property
    def row(self) -> Array:
        """Its numbers, as :mod:`drake_formation.systems.outlines` reads them."""
        return np.concatenate([self.vertices.ravel(), [self.radius], self.motion.ravel()])

    @property
    def is_convex(self) -> bool:
        """Whether it has no notch."""
        ahead = np.roll(self.vertices, -1, axis=0) - self.vertices
        beyond = np.roll(ahead, -1, axis=0)
        return bool((ahead[:, 0] * beyond[:, 1] - ahead[:, 1] * beyond[:, 0] >= 0).all())

    def displacement(self, time: ArrayLike) -> Array:
        """How far it has moved at some times (m), shape (..., 2)."""
        start, end, *velocity = self.motion.T[:, :, None] if len(self.motion) else np.zeros((4, 1, 1))
        moving = np.clip(np.ravel(time), start, end) - start
        moved: Array = np.stack([(v * moving).sum(axis=0) for v in velocity], axis=-1)
        return moved.reshape(*np.shape(time), 2)

    @property
    def top_speed(self) -> float:
        """The greatest speed at which it moves (m/s)."""
        return float(np.hypot(*self.motion[:, 2:].T).max(initial=0.0))

    def outline(self, time: float = 0.0) -> Array:
        """Its vertices at a time (m), shape (vertices, 2)."""
        return self.vertices + self.displacement(time)

    def edges(self) -> tuple[Array, Array]:
        """Where each edge begins and the way to its end before it moves (m), two of shape (edges, 2).

        A circle's centre is an edge of no length.
        """
        count = len(self.vertices)
        begins = self.vertices[: count if count != 2 else 1]
        ends = np.roll(self.vertices, -1, axis=0)[: len(begins)]
        return begins, ends - begins


@dataclass(frozen=True, eq=False)
class Obstacles:
    """Some obstacles.

    Attributes:
        items: one by one.
    """

    items: tuple[Obstacle, ...] = ()

    @classmethod
    def circles(cls, discs: ArrayLike) -> "Obstacles":
        """Circles at rest, from centre and radius of each (m), shape (M, 3)."""
        rows = np.reshape(np.asarray(discs, dtype=float), (-1, 3))
        return cls(tuple(Obstacle(row[None, :2], float(row[2])) for row in rows))

    def __len__(self) -> int:
        return len(self.items)

    def __iter__(self) -> Iterator[Obstacle]:
        return iter(self.items)

    def chosen(self, which: ArrayLike) -> "Obstacles":
        """Some of them, by a mask or by indices from 0."""
        mask = np.asarray(which)
        indices = np.flatnonzero(mask) if mask.dtype == bool else mask.astype(int)
        return Obstacles(tuple(self.items[k] for k in indices.tolist()))

    def grown(self, by: float) -> "Obstacles":
        """The same with larger radii (m)."""
        return Obstacles(tuple(replace(item, radius=item.radius + by) for item in self.items))

    def shifted(self, by: ArrayLike) -> "Obstacles":
        """The same at other places, moved by a vector (m)."""
        return Obstacles(tuple(replace(item, vertices=item.vertices + np.asarray(by)) for item in self.items))

    @cached_property
    def layout(self) -> Layout:
        """How many numbers each has."""
        return tuple(item.layout for item in self.items)

    @cached_property
    def numbers(self) -> Array:
        """The numbers of all, one row after the other."""
        return np.concatenate([np.zeros(0), *(item.row for item in self.items)])

    @property
    def are_circles(self) -> bool:
        """Whether all are circles at rest."""
        return all(layout == ROUND for layout in self.layout)

    @cached_property
    def discs(self) -> Array:
        """Centre and radius of each (m), shape (M, 3), where all are circles at rest.

        Raises:
            ValueError: they are not.
        """
        if not self.are_circles:
            raise ValueError("not all obstacles are circles at rest")
        return self.numbers.reshape(-1, 3)

    @cached_property
    def radii(self) -> Array:
        """Radius of each (m), shape (M,)."""
        return np.array([item.radius for item in self.items], dtype=float)

    @cached_property
    def middles(self) -> Array:
        """The centre of each circle, and the mean of others' vertices, before it moves (m), shape (M, 2)."""
        return np.array([item.vertices.mean(axis=0) for item in self.items], dtype=float).reshape(-1, 2)

    def outlines(self, times: Array) -> Array:
        """Vertices of each at some times (m), shape (times, M, vertices, 2); NaN where one has fewer than others."""
        most = max((vertices for vertices, _ in self.layout), default=0)
        result = np.full((len(times), len(self), most, 2), np.nan)
        for k, item in enumerate(self.items):
            result[:, k, : len(item.vertices)] = item.vertices + item.displacement(times)[:, None]
        return result

    @cached_property
    def edges(self) -> tuple[Array, Array]:
        """The edges of all before they move; see :meth:`Obstacle.edges`."""
        begins, ways = zip((np.zeros((0, 2)), np.zeros((0, 2))), *(item.edges() for item in self.items), strict=True)
        return np.concatenate(begins), np.concatenate(ways)

    @cached_property
    def edge_owners(self) -> NDArray[np.intp]:
        """Of each edge the index of its obstacle, shape (edges,)."""
        return np.repeat(np.arange(len(self)), [len(item.edges()[0]) for item in self.items])

    def displacements(self, time: ArrayLike) -> Array:
        """How far each has moved at some times (m), shape (..., M, 2)."""
        return np.stack([item.displacement(time) for item in self.items], axis=-2)

    @cached_property
    def turns(self) -> Array:
        """When any of them begins or ends to move or changes its velocity (s), ascending."""
        times = [item.motion[:, :2].ravel() for item in self.items]
        return np.unique(np.concatenate([np.zeros(0), *times]))

    def away(self, position: ArrayLike, time: ArrayLike = 0.0) -> tuple[Array, Array]:
        """Where points are from the nearest point of each outline.

        Args:
            position: (m), shape (..., 2).
            time: when (s), of a shape that goes with (...).

        Returns:
            The vectors (m), shape (..., M, 2), which inside a polygon point outward too; and what lies between their
            beginnings and the surfaces (m), shape (..., M).
        """
        place = np.asarray(position, dtype=float)
        x, y = place[..., 0], place[..., 1]
        vectors, surfaces = np.empty((*x.shape, len(self), 2)), np.empty((*x.shape, len(self)))
        found = offsets(x, y, np.asarray(time, dtype=float), self.numbers.tolist(), self.layout)
        for k, (dx, dy, surface) in enumerate(found):
            vectors[..., k, 0], vectors[..., k, 1], surfaces[..., k] = dx, dy, surface
        return vectors, surfaces

    def clearance(self, position: ArrayLike, time: ArrayLike = 0.0) -> Array:
        """Distance of points from the surface of each (m), negative inside; shape (..., M), as :meth:`away`."""
        vectors, surfaces = self.away(position, time)
        return length_of(vectors) - surfaces
