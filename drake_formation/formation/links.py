"""Who is linked to whom: the edges of the carried object, and the channels over which robots talk."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.formation import graphs

Array = NDArray[np.float64]
Pairs = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Edges:
    """Undirected edges between robots, from 0.

    Attributes:
        robots: number of robots N.
        pairs: (i, j) with i < j, ascending, shape (E, 2).
    """

    robots: int
    pairs: Pairs

    @classmethod
    def of(cls, graph: nx.Graph) -> "Edges":
        """The edges of a graph on 0 … N-1."""
        pairs = np.array(graphs.edges(graph), dtype=np.int64).reshape(-1, 2)
        pairs.setflags(write=False)
        return cls(graph.number_of_nodes(), pairs)

    @cached_property
    def graph(self) -> nx.Graph:
        """As a graph on 0 … N-1, which cannot be changed."""
        return nx.freeze(graphs.graph([(int(i), int(j)) for i, j in self.pairs], self.robots))

    @cached_property
    def neighbours(self) -> tuple[tuple[int, ...], ...]:
        """Of every robot, ascending: the order of its ports."""
        return tuple(tuple(graphs.neighbours(self.graph, i)) for i in range(self.robots))

    def _repr_svg_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.graph import graph_svg

        return graph_svg(self.robots, springs=[(i, j) for i, j in self.pairs.tolist()])

    def incident(self, robot: int) -> list[int]:
        """Rows of ``pairs`` of a robot's edges, in the order of its neighbours."""
        return [self._rows[min(robot, j), max(robot, j)] for j in self.neighbours[robot]]

    @cached_property
    def _rows(self) -> dict[tuple[int, int], int]:
        return {(i, j): row for row, (i, j) in enumerate(self.pairs.tolist())}

    def lengths(self, places: Array) -> Array:
        """Distance between the ends of every edge (m), shape (E,), where the robots are at places of shape (N, 2)."""
        lengths: Array = np.linalg.norm(places[self.pairs[:, 0]] - places[self.pairs[:, 1]], axis=-1)
        return lengths


@dataclass(frozen=True, eq=False)
class Channels:
    """Directed channels between robots, from 0: who hears whom, and how much it counts (paper, Sec. 2.1).

    Attributes:
        robots: number of robots N.
        pairs: (i, j) where robot i hears robot j, ascending, shape (C, 2).
        weights: γ_ij of each, shape (C,).
    """

    robots: int
    pairs: Pairs
    weights: Array

    @classmethod
    def of(cls, robots: int, weighted: Sequence[tuple[int, int, float]]) -> "Channels":
        """Channels from (listener, speaker, weight)."""
        ordered = sorted(weighted)
        pairs = np.array([(i, j) for i, j, _ in ordered], dtype=np.int64).reshape(-1, 2)
        weights = np.array([weight for _, _, weight in ordered], dtype=float)
        for array in (pairs, weights):
            array.setflags(write=False)
        return cls(robots, pairs, weights)

    def _repr_svg_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.graph import graph_svg

        return graph_svg(self.robots, channels=[(i, j) for i, j in self.pairs.tolist()])

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """What each is called where values are given or shown: what robot 2 tells robot 1 is ``2-1``."""
        return tuple(f"{speaker + 1}-{listener + 1}" for listener, speaker in self.pairs.tolist())

    @cached_property
    def adjacency(self) -> Array:
        """γ_ij, zero where i does not hear j, shape (N, N)."""
        matrix = np.zeros((self.robots, self.robots))
        matrix[self.pairs[:, 0], self.pairs[:, 1]] = self.weights
        return matrix

    @cached_property
    def laplacian(self) -> Array:
        """L = D − Γ, shape (N, N) (paper, Sec. 2.1); symmetric where the channels are."""
        laplacian: Array = np.diag(self.adjacency.sum(axis=1)) - self.adjacency
        return laplacian

    @cached_property
    def heard(self) -> tuple[tuple[int, ...], ...]:
        """The robots that every robot hears, ascending: the order of its ports."""
        speakers: list[list[int]] = [[] for _ in range(self.robots)]
        for i, j in self.pairs:
            speakers[int(i)].append(int(j))
        return tuple(map(tuple, speakers))

    def weights_of(self, robot: int) -> Array:
        """γ_ij of the channels that a robot hears, in the order of ``heard``."""
        weights: Array = self.weights[self.pairs[:, 0] == robot]
        return weights

    @cached_property
    def weighted(self) -> bool:
        """Whether any weight is not 1."""
        return bool((self.weights != 1.0).any())

    @cached_property
    def undirected(self) -> bool:
        """Whether robots hear each other alike, and each channel counts as much as the one back."""
        return bool(np.array_equal(self.adjacency, self.adjacency.T))

    @cached_property
    def graph(self) -> nx.Graph:
        """Who talks with whom in either direction, as an undirected graph on 0 … N-1 that cannot be changed."""
        result = nx.empty_graph(self.robots)
        result.add_edges_from((int(i), int(j)) for i, j in self.pairs)
        return nx.freeze(result)

    @cached_property
    def counted(self) -> list[graphs.Edge]:
        """Pairs (i, j) with i < j, ascending, of which one hears the other with a weight above 0."""
        heard = self.pairs[self.weights > 0]
        return sorted({(min(i, j), max(i, j)) for i, j in heard.tolist()})

    @cached_property
    def agree(self) -> bool:
        """Whether consensus brings all robots to agree: some robot is heard, over others, by all (paper, Lemma 1)."""
        heard = nx.DiGraph()
        heard.add_nodes_from(range(self.robots))
        heard.add_edges_from((int(j), int(i)) for (i, j), w in zip(self.pairs, self.weights, strict=True) if w > 0)
        sources = [min(part) for part in nx.strongly_connected_components(heard)]
        return any(len(nx.descendants(heard, source)) == self.robots - 1 for source in sources)
