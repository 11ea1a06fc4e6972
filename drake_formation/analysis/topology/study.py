"""Trying communication graphs for one formation and one measure: all of them, or those that a search comes upon."""

from functools import cached_property

import networkx as nx
import numpy as np

from drake_formation.analysis.linear.assumptions import require_displacements
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.response.error_criteria import Measure
from drake_formation.analysis.topology.bounds import least_error
from drake_formation.analysis.topology.enumeration import Catalogue, catalogue
from drake_formation.analysis.topology.reduced_graphs import with_all_channels, with_channels
from drake_formation.analysis.topology.results import CheapestGraph, GraphPoint
from drake_formation.analysis.topology.search import exchanged, starting_points, thinned
from drake_formation.formation import graphs

FRONT = 24
"""Numbers of edges that a front shows where not all graphs can be tried."""

MOST_EVALUATIONS = 60
"""Errors computed at most in one search."""


class GraphStudy:
    """Graphs tried for one formation and measure.

    Args:
        formation: the linearized formation; its own graph plays no part.
        measure: which error.
        exhaustive: the most graphs to try one by one.

    Attributes:
        tried: channels and error (m) of every graph tried.
        all_graphs: all that need to be tried, by their number of edges; None where there are too many.
        words: what they are.

    Raises:
        IllPosedError: there is one robot only, or robots compare distances.
    """

    def __init__(self, formation: LinearFormation, measure: Measure, exhaustive: int) -> None:
        if formation.robots < 2:
            raise IllPosedError("one robot has nobody to talk with: a communication graph takes at least two robots")
        require_displacements(formation.resolved, "the search for channels")
        self.measure = measure
        self.complete = with_all_channels(formation)
        self.least_error = least_error(self.complete, measure)
        self.tried: list[tuple[int, float]] = []
        known = catalogue(self.complete, of_every_robot=measure.of_every_robot)
        few = known is not None and sum(map(len, known[0].values())) <= exhaustive
        self.all_graphs: Catalogue | None = known[0] if known and few else None
        self.words = known[1] if known else ""

    @property
    def most_edges(self) -> int:
        """Edges of the complete graph."""
        return self.complete.robots * (self.complete.robots - 1) // 2

    @property
    def bounded(self) -> bool:
        """Whether a lower bound on the error is known."""
        return self.least_error(self.most_edges) > 0

    @property
    def patience(self) -> int:
        """Errors to compute in one search: an error costs some N³, and Harary's graphs leave little to gain."""
        return min(MOST_EVALUATIONS, 2 + 4000 // self.complete.robots**2)

    @cached_property
    def path(self) -> dict[int, nx.Graph]:
        """The complete graph, thinned to every number of edges."""
        return thinned(self.complete.robots)

    def error(self, graph: nx.Graph) -> float:
        """The error of a graph (m), kept."""
        found = self.measure.error_m(with_channels(self.complete, graph))
        self.tried.append((graphs.channels(graph), found))
        return found

    def point(self, graph: nx.Graph, error: float, bound: float) -> GraphPoint:
        """A graph with its error and the bound on that of others (m)."""
        edges = tuple((i + 1, j + 1) for i, j in graphs.edges(graph))
        spectrum = np.linalg.eigvalsh(graphs.laplacian(graph))
        rounded = tuple(float(value) for value in np.where(np.abs(spectrum) < 1e-9, 0.0, spectrum))
        return GraphPoint(edges, graphs.channels(graph), error, rounded, bound)

    def best(self, candidates: list[nx.Graph], *, every: bool) -> GraphPoint:
        """The best of some graphs with as many edges; ``every`` if there are no others."""
        errors = [self.error(graph) for graph in candidates]
        first = int(np.argmin(errors))
        graph, error = candidates[first], errors[first]
        return self.point(graph, error, error if every else self.least_error(graph.number_of_edges()))

    def search(self, edges: int, enough: float = 0.0, evaluations: int | None = None) -> GraphPoint:
        """A good graph with so many edges; the search ends at an error that is enough (m), or after so many errors."""
        starts = {start: self.error(start) for start in starting_points(self.complete.robots, edges, self.path)}
        start = min(starts, key=lambda graph: starts[graph])
        graph, error = exchanged(start, self.error, enough=enough, evaluations=evaluations or self.patience)
        return self.point(graph, error, self.least_error(edges))

    def some_edges(self) -> list[int]:
        """Numbers of edges to show, closer together where there are few."""
        fewest = self.complete.robots - 1
        return sorted({round(edges) for edges in np.geomspace(fewest, self.most_edges, FRONT)})

    def least_edges(self, bound: float) -> int:
        """Fewest edges that the lower bound on the error allows."""
        allowed = range(self.complete.robots - 1, self.most_edges + 1)
        return next((edges for edges in allowed if self.least_error(edges) <= bound), self.most_edges + 1)

    def proven(self, bound: float, all_graphs: Catalogue) -> CheapestGraph:
        """The cheapest of all graphs.

        Raises:
            IllPosedError: none meets the bound.
        """
        least = self.least_edges(bound)
        skipped = sum(len(candidates) for edges, candidates in all_graphs.items() if edges < least)
        lowest: GraphPoint | None = None
        for edges, candidates in all_graphs.items():
            if edges < least:
                continue
            failed = len(self.tried)
            point = self.best(candidates, every=True)
            if point.error_m <= bound:
                proof = _exhausted(failed, skipped, edges, self.words)
                return CheapestGraph(point, bound, str(self.measure), point.channels, True, proof)
            lowest = point if lowest is None or point.error_m < lowest.error_m else lowest
        raise self._infeasible(bound, lowest)

    def searched(self, bound: float) -> CheapestGraph:
        """The cheapest graph that a search finds.

        Raises:
            IllPosedError: the complete graph does not meet the bound.
        """
        least = self.least_edges(bound)
        if least > self.most_edges:
            raise self._infeasible(bound, None)
        point = self._first_feasible(least, bound)
        while point.channels // 2 > least:
            fewer = self.search(point.channels // 2 - 1, enough=bound)
            if fewer.error_m > bound:
                break
            point = fewer
        optimal = point.channels == 2 * least
        why = "connected" if least == self.complete.robots - 1 else "in which every robot has neighbours enough"
        proof = f"a graph {why} takes at least {2 * least} channels" + (
            "" if optimal else "; this one comes from a search"
        )
        return CheapestGraph(point, bound, str(self.measure), 2 * least, optimal, proof)

    def _first_feasible(self, least: int, bound: float) -> GraphPoint:
        """A graph that meets the bound, by bisection of the thinned graphs."""
        low, high = least, self.most_edges
        best = self.best([self.path[high]], every=True)
        if best.error_m > bound:
            raise self._infeasible(bound, best)
        while low < high:
            middle = (low + high) // 2
            point = self.search(middle, enough=bound, evaluations=1)
            if point.error_m <= bound:
                best, high = point, middle
            else:
                low = middle + 1
        return best

    def _infeasible(self, bound: float, lowest: GraphPoint | None) -> IllPosedError:
        complete = self.error(graphs.graph("complete", self.complete.robots))
        least = lowest if lowest and lowest.error_m < complete * (1 - 1e-6) else None
        other = f"; the least found is {least.error_m:.4g} m with {least.channels} channels" if least else ""
        return IllPosedError(
            f"no connected communication graph was found to keep the {self.measure} within {bound:.4g} m: the complete "
            f"one with {2 * self.most_edges} channels reaches {complete:.4g} m{other}. Allow a larger error, or raise "
            "the gains consensus.delta or consensus.delta_v"
        )


def _exhausted(failed: int, skipped: int, edges: int, words: str) -> str:
    parts = []
    if failed:
        parts.append(f"{failed} connected graphs with fewer channels were tried and exceed the bound")
    if skipped:
        parts.append(f"{skipped} more exceed it since some robot has too few neighbours")
    if not parts:
        return f"a connected graph takes at least {2 * edges} channels"
    return "; ".join(parts) + f" ({words.format(failed + skipped)} with fewer channels)"
