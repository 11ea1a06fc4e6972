"""Springs that are not at rest where their robots are in their slots."""

import numpy as np
import pytest

from drake_formation import (
    ScenarioError,
    build_diagram,
    load_scenario,
    metrics,
    set_parameters,
    simulate,
    with_overrides,
)
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.scenario import resolve

FREE = {
    "aggregation.duration": 0.0,
    "robots.start": {"centre": [2.5, 3.5]},
    "tracking": {"kind": "none"},
    "avoidance.obstacles": [],
    "springs.stiffness": 20.0,
}
"""Two robots a metre apart that only the spring moves."""


def line(name="line", **springs):
    changes = {f"springs.{key}": value for key, value in springs.items()}
    return load_scenario(name, overrides=FREE | {"transport.duration": 2.0} | changes)


def first_forces(scenario):
    return simulate(scenario, engine="blocks")["spring_force"].values[0]


@pytest.mark.parametrize("law", ["hookean", "linear"])
@pytest.mark.parametrize("tension", [3.0, -5.0])
def test_in_their_slots_it_draws_with_its_tension(law, tension):
    scenario = line(law=law, pre_tension=tension)
    apart = resolve(scenario).slots[1] - resolve(scenario).slots[0]
    np.testing.assert_allclose(first_forces(scenario), [tension * apart, -tension * apart], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("engine", ["blocks", "compiled", "exponential"])
def test_robots_that_nothing_else_moves_come_to_rest_at_its_length(engine):
    """One mode of ω² = 2 k/m = 1 and damping 2 c/m = 2: critically damped."""
    scenario = with_overrides(line(rest_length=0.8, damping=40.0), {"transport.duration": 40.0})
    assert resolve(scenario).rest_lengths == pytest.approx([0.8])
    result = simulate(scenario, engine=engine)
    assert result["spring_length"].values[-1] == pytest.approx([0.8], abs=1e-6)
    centre = result["position"].values.mean(axis=1)
    np.testing.assert_allclose(centre, np.broadcast_to([2.5, 3.5], centre.shape), atol=1e-12)
    assert metrics(result).max_spring_strain == pytest.approx(0.25, abs=1e-6)


def test_a_tension_is_a_rest_length():
    tense, short = (simulate(line(**given), engine="blocks") for given in ({"pre_tension": 4.0}, {"rest_length": 0.8}))
    np.testing.assert_allclose(tense["position"], short["position"], atol=1e-12)


def test_each_edge_has_its_own_and_a_context_takes_it():
    base = FREE | {"robots.start": {"centre": [1.7, 3.5]}}
    scenario = load_scenario("quadrilateral", overrides=base | {"springs.rest_length": {"1-3": 1.3}})
    formation = resolve(scenario)
    lengths = dict(zip(map(tuple, formation.springs.pairs.tolist()), formation.rest_lengths, strict=True))
    assert lengths[0, 2] == 1.3
    assert lengths[0, 1] == pytest.approx(1.0)
    diagram, rebuilt = build_diagram(load_scenario("quadrilateral", overrides=base)), build_diagram(scenario)
    context, other = diagram.CreateDefaultContext(), rebuilt.CreateDefaultContext()
    set_parameters(diagram, context, scenario)
    for robot, pulled in ((1, True), (2, False), (3, True), (4, False)):
        name = f"robot_{robot}_spring_force"
        force = diagram.GetOutputPort(name).Eval(context)
        np.testing.assert_array_equal(force, rebuilt.GetOutputPort(name).Eval(other))
        assert np.linalg.norm(force) == pytest.approx(20.0 * (2**0.5 - 1.3) if pulled else 0.0, abs=1e-12)


def test_a_length_that_is_the_slots_changes_nothing():
    written = line(rest_length=1.0)
    assert resolve(written).at_rest_in_slots
    np.testing.assert_array_equal(simulate(written)["position"], simulate(line())["position"])
    assert linearize(written).robots == 2


@pytest.mark.parametrize("springs", [{"rest_length": 0.9}, {"pre_tension": 1.0}])
def test_a_certificate_is_of_a_formation_at_rest(springs):
    with pytest.raises(IllPosedError, match="springs have tension in the slots"):
        linearize(line(**springs))


@pytest.mark.parametrize(
    ("springs", "said"),
    [
        ({"pre_tension": 1.0, "rest_length": 0.9}, "pre_tension: given together with rest_length"),
        ({"pre_tension": 20.0}, r"rest at no length \(got 20\.0\); allowed: less than k_ij d_ij = 20 N"),
        ({"pre_tension": 1.0, "stiffness": 0.0}, "a spring without stiffness has none"),
        ({"rest_length": 0.0}, "rest_length: out of range"),
    ],
)
def test_a_spring_that_is_at_rest_nowhere_or_twice_is_refused(springs, said):
    with pytest.raises(ScenarioError, match=said):
        line(**springs)
