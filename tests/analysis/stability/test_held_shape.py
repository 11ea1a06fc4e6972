"""What distances over channels and along springs hold: counted, and read off Drake's linearization of the springs."""

import numpy as np
import pytest
from hypothesis import given, settings
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis import certify
from drake_formation.analysis.linear.linearization import linearize
from drake_formation.analysis.stability.held_shape import held_shape, stiff_springs
from drake_formation.analysis.stability.rigidity import spring_linearization
from drake_formation.scenario import resolve

HEXAGON = {"formation": {"shape": "polygon", "robots": 6, "side": 1.0}, "robots.start": {"centre": [0.0, 0.0]}}
UTILITIES = [[i, j] for i in (1, 2, 3) for j in (4, 5, 6)]


def held(name="quadrilateral", **overrides):
    named = {path.replace("__", "."): value for path, value in overrides.items()}
    return held_shape(resolve(load_scenario(name, overrides=named)))


@given(scenario=scenarios())
@settings(max_examples=15)
def test_the_object_is_counted_as_its_linearization_is(scenario):
    formation = linearize(scenario)
    if not stiff_springs(formation.resolved):
        return
    found, exact = held_shape(formation.resolved).object, spring_linearization(formation)
    assert (found.rank, found.mechanisms, found.rigid) == (exact.rank, exact.mechanisms, exact.rigid)


@pytest.mark.parametrize("stiffness", [1.45, 3e4])
def test_the_softest_change_of_shape_is_that_of_drakes_stiffness(stiffness):
    braced = [[1, 2], [2, 3], [3, 4], [1, 4], [1, 3]]
    overrides = {"springs.graph": braced, "springs.stiffness": stiffness}
    formation = linearize(load_scenario("quadrilateral", overrides=overrides))
    values = np.linalg.eigvalsh(spring_linearization(formation).exact)
    assert values[3] == pytest.approx(stiffness * held_shape(formation.resolved).object.softest, rel=1e-6)


def test_channels_without_weight_hold_nothing():
    complete = [[i, j] for i in (1, 2, 3, 4) for j in range(i + 1, 5)]
    idle = [{"speaker": 1, "listener": 3, "weight": 0.0}, {"speaker": 3, "listener": 1, "weight": 0.0}]
    assert held(consensus__graph=complete).channels.edges == 6
    found = held(consensus__graph=[edge for edge in complete if edge != [1, 3]] + idle).channels
    assert (found.edges, found.rank, found.minimally_rigid) == (5, 5, True)


def test_two_flexible_frameworks_hold_a_shape_together():
    found = held(consensus__graph="cycle", springs__graph=[[1, 3], [2, 4]])
    assert not found.channels.rigid
    assert not found.object.rigid
    assert found.together.rigid
    assert "Both together: 6 distances of rank 5, rigid, 1 more than needed" in found.meaning()[-1]


def test_robots_on_a_circle_are_in_a_special_position():
    """Three that hear three others are minimally rigid, but not where all six lie on a conic (Bolker and Roth 1980)."""
    found = held("octagon", **HEXAGON, consensus__graph=UTILITIES).channels
    assert (found.edges, found.needed, found.rank) == (9, 9, 8)
    assert found.generically_rigid
    assert not found.rigid
    moved = HEXAGON | {"formation": {"shape": "slots", "slots": [[0, 0], [1, 0.2], [2, 0], [0, 1], [1.3, 1], [2, 1.4]]}}
    assert held("octagon", **moved, consensus__graph=UTILITIES).channels.minimally_rigid


def test_the_certificate_holds_it():
    told = certify(load_scenario("quadrilateral", overrides={"consensus.graph": "cycle"})).to_dict()["rigidity"]
    assert (told["channels"]["rigidity_rank"], told["channels"]["laman_count"]) == (4, 5)
    assert told["channels"]["smallest_eigenvalue"] == 0
    assert told["object"]["rigid"]
    assert told["object"]["smallest_eigenvalue"] > 0
