"""The runs of the study are the shipped scenarios with a few fields replaced."""

import pytest

from drake_formation.formation import graphs
from drake_formation.paper.runs import CASES, FORMATIONS, GAINS, MATERIALS, TOPOLOGIES, aggregation, topology, transport
from drake_formation.scenario import resolve


@pytest.mark.parametrize("formation", FORMATIONS)
def test_each_formation_has_a_run_for_every_material_and_gain(formation):
    runs = [transport(*case) for case in CASES if case[0] == formation]
    cells = {(run.springs.stiffness, run.consensus.delta) for run in runs}
    assert cells == {(stiffness, delta) for stiffness in MATERIALS.values() for delta in GAINS}


def test_topologies_are_connected_and_have_the_channels_they_are_named_after():
    for name in TOPOLOGIES:
        graph = resolve(topology(name)).channels.graph
        assert graphs.channels(graph) == int(name.split()[0])
        assert graphs.algebraic_connectivity(graph) > 0


def test_aggregation_keeps_the_object_of_the_shipped_scenario():
    assert aggregation("line", 5.0).consensus.delta == 5.0
    assert aggregation("line", 0.0).springs.stiffness == MATERIALS["rubber"]


@pytest.mark.parametrize(("name", "stiffness"), MATERIALS.items())
def test_runs_have_the_stiffness_of_table_1(name, stiffness):
    assert transport("line", name, 0.0).springs.stiffness == stiffness
