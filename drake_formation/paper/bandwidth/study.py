"""Every graph of the study simulated under both laws, and the result that is kept with the package."""

import csv
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np

from drake_formation.formation import graphs
from drake_formation.formation.rigidity import rigid_rank, rigidity_rank
from drake_formation.paper.bandwidth.graphs import ROBOTS, Placed, placed_graphs
from drake_formation.paper.bandwidth.runs import LAWS, formation, handed_over, talk_over
from drake_formation.scenario import resolve
from drake_formation.sweep import SweepStoppedError, Tally, run_sweep

KEPT = "topologies.csv"
"""Name of the result's file, beside this one and in a folder of one's own."""

DIGITS = 4
"""Places behind the point of an error (cm) in the file."""


@dataclass(frozen=True)
class Tried:
    """A communication graph and what came of it.

    Attributes:
        shape: number of its class of isomorphic graphs, among those of as many robots.
        graph: who talks with whom, robots from 0.
        rank: of its rigidity matrix in the slots.
        errors: largest consensus error (cm) by law.
    """

    shape: int
    graph: nx.Graph
    rank: int
    errors: dict[str, float]

    @property
    def robots(self) -> int:
        """Number of robots N."""
        return int(self.graph.number_of_nodes())

    @property
    def channels(self) -> int:
        """Number of channels, two an edge."""
        return graphs.channels(self.graph)

    @property
    def rigid(self) -> bool:
        """Whether distances over its channels hold the shape, to first order."""
        return self.rank == rigid_rank(self.robots)

    @property
    def minimally_rigid(self) -> bool:
        """Whether they do so and every one of them is needed."""
        return self.rigid and self.graph.number_of_edges() == self.rank


def run_study(folder: Path, progress: Callable[[int, int], None] | None = None) -> list[Tried]:
    """Simulate every graph under both laws, or what is missing of it, and write the result to a folder.

    Args:
        folder: for the runs, a sweep for each number of robots, and ``topologies.csv``; made if missing.
        progress: called with how many runs are done and how many there are.

    Raises:
        SweepError: the folder holds something else, or runs of other software.
        SweepStoppedError: it cannot go on; what was finished is kept.
    """
    placed = {robots: placed_graphs(robots) for robots in ROBOTS}
    total = sum(len(tried) for tried in placed.values()) * len(LAWS)
    found: list[Tried] = []

    def tell(before: int) -> Callable[[Tally], None] | None:
        return progress and (lambda tally: progress(before + tally.finished, total))

    for robots, candidates in placed.items():
        found += tried(robots, candidates, folder / str(robots), tell(len(found) * len(LAWS)))
    try:
        write(folder / KEPT, found)
    except OSError as error:
        raise SweepStoppedError(f"{folder / KEPT}: cannot be written: {error.strerror or error}") from error
    return found


def largest_difference(found: Iterable[Tried]) -> float:
    """By how much errors differ from those that are kept with the package, at the most (cm).

    Raises:
        KeyError: a graph is not among those kept.
    """
    known = {graph6(one.graph): one.errors for one in kept()}
    return max(abs(one.errors[law] - known[graph6(one.graph)][law]) for one in found for law in LAWS)


def tried(
    robots: int, candidates: list[Placed], folder: Path, progress: Callable[[Tally], None] | None = None
) -> list[Tried]:
    """Simulate some graphs between as many robots under both laws, by a sweep in a folder.

    Raises:
        SweepError, SweepStoppedError: as for :func:`run_study`; the latter also where a run failed.
    """
    points = [{"label": graph6(one.graph), "set": talk_over(one.graph)} for one in candidates]
    sweep = {
        "name": f"topologies-{robots}",
        "scenario": handed_over(robots),
        "axes": [{"kind": "list", "name": "graph", "points": points}, {"path": "consensus.law", "values": list(LAWS)}],
    }
    with run_sweep(sweep, folder, figures=False, progress=progress) as dataset:
        errors = 100 * dataset["consensus_error_m"].values
    if np.isnan(errors).any():
        raise SweepStoppedError(f"{folder}: {np.isnan(errors).sum()} of {errors.size} runs failed")
    slots = resolve(formation(robots)).slots
    return [
        Tried(one.shape, one.graph, rigidity_rank(slots, graphs.edges(one.graph)), dict(zip(LAWS, row, strict=True)))
        for one, row in zip(candidates, errors.tolist(), strict=True)
    ]


def write(path: Path, found: Iterable[Tried]) -> None:
    """Write the result, one graph a row."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["graph6", "shape", "rank", *(f"{law}_cm" for law in LAWS)])
        for one in found:
            errors = [f"{one.errors[law]:.{DIGITS}f}" for law in LAWS]
            writer.writerow([graph6(one.graph), one.shape, one.rank, *errors])


@cache
def kept() -> tuple[Tried, ...]:
    """The result that is kept with the package, as ``drake-formation reproduce --topologies`` makes it."""
    lines = files(__package__).joinpath(KEPT).read_text(encoding="utf-8").splitlines()
    return tuple(map(_row, csv.DictReader(lines)))


def _row(row: dict[str, Any]) -> Tried:
    graph = nx.from_graph6_bytes(row["graph6"].encode())
    return Tried(int(row["shape"]), graph, int(row["rank"]), {law: float(row[f"{law}_cm"]) for law in LAWS})


def graph6(graph: nx.Graph) -> str:
    """A graph between numbered robots as a short word (McKay's graph6)."""
    word: bytes = nx.to_graph6_bytes(graph, nodes=sorted(graph), header=False)
    return word.decode().strip()
