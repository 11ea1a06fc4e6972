"""The study that is kept: complete, and as a fresh run gives it."""

import re
from pathlib import Path

import networkx as nx
import pytest

from drake_formation.formation import graphs
from drake_formation.formation.rigidity import rigidity_rank
from drake_formation.paper.bandwidth import study
from drake_formation.paper.bandwidth.graphs import ROBOTS, Placed, placed_graphs
from drake_formation.paper.bandwidth.runs import LAWS, formation
from drake_formation.paper.bandwidth.study import Tried, graph6, kept, largest_difference, tried, write
from drake_formation.scenario import resolve


@pytest.mark.parametrize("robots", ROBOTS)
def test_every_graph_is_kept(robots):
    found = [one for one in kept() if one.robots == robots]
    assert [(graph6(one.graph), one.shape) for one in found] == [
        (graph6(placed.graph), placed.shape) for placed in placed_graphs(robots)
    ]
    slots = resolve(formation(robots)).slots
    assert all(one.rank == rigidity_rank(slots, graphs.edges(one.graph)) for one in found[::11])


@pytest.mark.slow
@pytest.mark.parametrize("robots", [4, 7])
def test_a_fresh_run_gives_what_is_kept(robots, tmp_path):
    """The worst of the flexible graphs, a minimally rigid one, and no channels."""
    known = [one for one in kept() if one.robots == robots]
    flexible = max((one for one in known if one.channels and not one.rigid), key=lambda one: one.errors["hookean"])
    chosen = [flexible, next(one for one in known if one.minimally_rigid), known[0]]
    fresh = tried(robots, [Placed(one.shape, one.graph) for one in chosen], tmp_path)
    assert [one.rank for one in fresh] == [one.rank for one in chosen]
    assert largest_difference(fresh) < 1e-3  # cm


def test_a_result_is_read_as_it_was_written(tmp_path):
    one = Tried(3, nx.path_graph(4), 3, dict.fromkeys(LAWS, 1.23456))
    write(tmp_path / "found.csv", [one])
    assert (tmp_path / "found.csv").read_text() == "graph6,shape,rank,hookean_cm,linear_cm\nCh,3,3,1.2346,1.2346\n"


def test_a_difference_is_seen():
    one = kept()[1]
    other = Tried(one.shape, one.graph, one.rank, one.errors | {"linear": one.errors["linear"] + 0.5})
    assert largest_difference([one]) == 0
    assert largest_difference([other]) == pytest.approx(0.5)


@pytest.mark.slow
def test_the_command_tries_them_again_and_compares(cli, monkeypatch):
    monkeypatch.setattr(study, "ROBOTS", [3])
    status, out, _ = cli("reproduce", "--topologies", "--out", "o")
    assert status == 0
    assert "5 graphs tried" in out
    differing = float(re.search(r"by at most (\S+)", " ".join(out.split()))[1])
    assert differing < 1e-3
    assert len(Path("o/topologies/topologies.csv").read_text().splitlines()) == 6
