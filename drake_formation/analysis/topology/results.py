"""Communication graphs and how well they serve: answers of :mod:`drake_formation.analysis.topology.cheapest_graph`."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation import graphs

Array = NDArray[np.float64]


@dataclass(frozen=True)
class GraphPoint:
    """A communication graph and how well it serves.

    Attributes:
        edges: who talks, robots from 1.
        channels: two an edge, one each way.
        error_m: the consensus error under the stated disturbance (m).
        spectrum: Laplacian eigenvalues, ascending.
        bound_m: no graph with as many channels has a smaller error (m); the error itself where all were tried.
    """

    edges: tuple[graphs.Edge, ...]
    channels: int
    error_m: float
    spectrum: tuple[float, ...]
    bound_m: float

    def _repr_svg_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.topology import graph_point_svg

        return graph_point_svg(self)

    def to_dict(self) -> dict[str, Any]:
        """Plain values, units in the keys."""
        return {
            "edges": [list(edge) for edge in self.edges],
            "channels": self.channels,
            "error_m": self.error_m,
            "least_error_m": self.bound_m,
            "laplacian_eigenvalues": list(self.spectrum),
        }


@dataclass(frozen=True)
class CheapestGraph:
    """The graph with the fewest channels that keeps an error below a bound.

    Attributes:
        graph: the best found with so few channels.
        error_bound_m: what was asked for (m).
        measure: which error, in words.
        least_channels: no connected graph with fewer channels than this meets the bound.
        optimal: whether the graph has just so many channels.
        proof: why so, in words.
    """

    graph: GraphPoint
    error_bound_m: float
    measure: str
    least_channels: int
    optimal: bool
    proof: str

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.topology import cheapest_graph_html

        return cheapest_graph_html(self)

    def to_dict(self) -> dict[str, Any]:
        """Plain values, units in the keys."""
        return {
            **self.graph.to_dict(),
            "error_bound_m": self.error_bound_m,
            "measure": self.measure,
            "least_channels": self.least_channels,
            "optimal": self.optimal,
            "proof": self.proof,
        }


@dataclass(frozen=True)
class ParetoFront:
    """The best graph for every number of channels.

    Attributes:
        points: by channels, ascending; a graph with more channels may be worse than one with fewer.
        measure: which error, in words.
        exact: whether no graph with as many channels is better than the one given.
        proof: why so, in words.
        tried: channels and error (m) of every graph tried, shape (graphs, 2).
    """

    points: tuple[GraphPoint, ...]
    measure: str
    exact: bool
    proof: str
    tried: Array

    @property
    def front(self) -> tuple[GraphPoint, ...]:
        """The points that none with fewer channels equals or beats."""
        kept: list[GraphPoint] = []
        for point in self.points:
            if not kept or point.error_m < kept[-1].error_m * (1 - 1e-6):
                kept.append(point)
        return tuple(kept)

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.topology import pareto_front_html

        return pareto_front_html(self)

    def to_dict(self) -> dict[str, Any]:
        """Plain values, units in the keys."""
        points = [point.to_dict() for point in self.points]
        return {"points": points, "measure": self.measure, "exact": self.exact, "proof": self.proof}
