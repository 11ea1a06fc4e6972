"""Springs and grips that break: for good, when they are looked at, and with what physics keeps."""

import numpy as np
import pytest
from carrying import carried

from drake_formation import build_diagram, load_scenario, metrics, simulate
from drake_formation.parameters import set_parameters
from drake_formation.scenario import ScenarioError, resolve
from drake_formation.simulation import events

FREE = {
    "formation": {"shape": "line", "robots": 2, "side": 1.0},
    "robots.start": {"centre": [0.0, 0.0]},
    "robots.mass": [40.0, 20.0],
    "robots.velocity": {"1": [0.3, -0.1], "2": [0.3, 0.5]},
    "tracking": {"kind": "none"},
    "consensus": {"kind": "none"},
    "avoidance.obstacles": [],
    "aggregation.duration": 0.0,
    "transport.duration": 0.6,
    "transport.goal": [1.0, 0.0],
    "springs.stiffness": 50.0,
    "simulator.accuracy": 1e-10,
}
"""Two masses that nothing but a spring holds; the second runs away from the first."""


def free(**more):
    return load_scenario("line", overrides=FREE | more)


def momentum_and_energy(result, stiffness, acting):
    masses = np.array([40.0, 20.0])
    velocity, position = result["velocity"].values, result["position"].values
    length = np.linalg.norm(position[:, 0] - position[:, 1], axis=-1)
    momentum = (masses[:, None] * velocity).sum(axis=1)
    kinetic = 0.5 * (masses * (velocity**2).sum(axis=-1)).sum(axis=-1)
    return momentum, kinetic, 0.5 * stiffness * (length - 1.0) ** 2 * acting


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_a_broken_spring_keeps_momentum_and_takes_its_energy_along(engine):
    """What the spring had stored is lost, as the break sets no mass in motion, and nothing else is."""
    result = simulate(free(**{"springs.break_at_strain": 0.08}), engine=engine)
    (event,) = events(result)
    at = int(np.searchsorted(result["time"], event.time))
    acting = np.arange(result.sizes["time"]) <= at
    momentum, kinetic, stored = momentum_and_energy(result, 50.0, acting)
    np.testing.assert_allclose(momentum, np.broadcast_to(momentum[0], momentum.shape), rtol=1e-9)
    np.testing.assert_allclose((kinetic + stored)[: at + 1], kinetic[0], rtol=1e-8)
    np.testing.assert_allclose(kinetic[at:], kinetic[0] - stored[at], rtol=1e-8)
    assert (result["spring_force"].values[at + 1 :] == 0).all()
    strain = float(result["spring_length"][at, 0]) - 1.0
    assert 0.08 < strain < 0.08 + 1e-3 * 0.7, "seen at the first look after the bound, at the rate of 0.6 m/s"
    assert event.place == pytest.approx(result["position"][at].values.mean(axis=0), rel=1e-12)
    assert metrics(result).max_spring_strain == pytest.approx(strain, abs=1e-9)


def test_engines_see_the_same_break():
    scenario = free(**{"springs.break_at_force": 3.0, "object": {"kind": "springs", "look_every": 0.01}})
    first, second = (events(simulate(scenario, engine=engine)) for engine in ("blocks", "compiled"))
    assert [(event.time, event.sentence) for event in first] == [(event.time, event.sentence) for event in second]
    assert "between robots 1 and 2" in first[0].sentence


def test_a_break_is_seen_at_the_first_look_and_nothing_shorter():
    coarse = free(**{"springs.break_at_strain": 0.08, "object": {"kind": "springs", "look_every": 0.1}})
    (event,) = events(simulate(coarse, engine="blocks"))
    fine = events(simulate(free(**{"springs.break_at_strain": 0.08}), engine="blocks"))[0]
    assert event.time == pytest.approx(np.ceil(fine.time / 0.1) * 0.1)
    blind = free(**{"springs.break_at_strain": 0.08, "object": {"kind": "springs", "look_every": 0.7}})
    assert events(simulate(blind, engine="blocks")) == ()


def test_off_by_default_costs_no_block_and_no_bit():
    plain, bound = simulate(free(), engine="blocks"), free(**{"springs.break_at_strain": 10.0})
    assert not build_diagram(free()).HasSubsystemNamed("breaking")
    assert "broken_at" not in plain
    held = simulate(bound, engine="blocks")
    assert np.isnan(held["broken_at"].values).all()
    np.testing.assert_allclose(held["position"][-1], plain["position"][-1], rtol=1e-9)


def test_only_the_weakest_spring_breaks():
    bounds = [0.5, 0.5, 0.01, 0.5, 0.5, 0.5]
    scenario = load_scenario(
        "quadrilateral",
        overrides={
            "aggregation.duration": 0.0,
            "robots.start": [[2.0, 4.0], [2.05, 3.0], [3.0, 3.0], [3.1, 4.0]],
            "transport.duration": 0.2,
            "springs.break_at_strain": bounds,
            "object": {"kind": "springs", "look_every": 0.01},
        },
    )
    result = simulate(scenario, engine="blocks")
    assert [event.who for event in events(result)] == [(1, 4)]
    assert result["spring"].values[np.isfinite(result["broken_at"].values)].tolist() == ["1-4"]


def test_bounds_are_parameters_of_the_diagram():
    weak, strong = free(**{"springs.break_at_strain": 0.05}), free(**{"springs.break_at_strain": 0.2})
    diagram = build_diagram(strong)
    context = diagram.CreateDefaultContext()
    set_parameters(diagram, context, weak)
    block = diagram.GetSubsystemByName("breaking")
    bounds = block.GetMyContextFromRoot(context).get_numeric_parameter(1).CopyToVector()
    assert bounds.tolist() == [0.05, np.inf]
    with pytest.raises(ValueError, match="structure"):
        set_parameters(diagram, context, free())


PLATES = {
    "rigid": "{kind: rigid, grip_strength: 100, look_every: 0.005}",
    "lattice": "{kind: lattice, rows: 2, columns: 2, grip_strength: 60, look_every: 0.005}",
}
OFF = {
    "robots": "{start: [[1.0, 4.0], [1.0, 2.0], [3.0, 2.0], [3.02, 4.0]]}",
    "aggregation": "{duration: 0}",
    "transport": "{goal: [2.0, 3.0], duration: 0.3}",
}
"""The last robot starts 2 cm off its grip, which takes 200 N there; the grips of the others bear their share."""


@pytest.mark.slow
@pytest.mark.parametrize("kind", PLATES)
def test_a_grip_that_is_pulled_too_hard_lets_go_for_good(kind):
    scenario = carried(PLATES[kind], **OFF)
    first, second = (simulate(scenario, engine=engine) for engine in ("blocks", "compiled"))
    (event,) = events(first)
    assert (event.time, event.who) == (0.005, (4,))
    assert [(other.time, other.who) for other in events(second)] == [(0.005, (4,))]
    assert event.place == pytest.approx(first["position"].sel(robot=4, time=0.005).values)
    after = first["time"].values > 0.005
    assert (first["spring_force"].sel(robot=4).values[after] == 0).all()
    assert float(abs(first["spring_force"].sel(robot=1)).max()) > 0
    assert float(first["object_strain"][-1]) < 0.01, "the grip that broke has no part in it"
    np.testing.assert_allclose(first["object_pose"][-1], second["object_pose"][-1], rtol=1e-6, atol=1e-6)


def test_a_grip_that_bears_all_is_as_one_without_bound():
    strong, plain = (
        simulate(carried(f"{{kind: rigid{more}}}", **OFF), engine="blocks") for more in (", grip_strength: 1e9", "")
    )
    assert events(strong) == ()
    np.testing.assert_allclose(strong["object_pose"][-1], plain["object_pose"][-1], rtol=1e-5, atol=1e-6)


def test_what_cannot_be_is_refused_with_its_place():
    with pytest.raises(ScenarioError, match=r"springs.break_at_strain\.2-1|springs.break_at_strain"):
        resolve(free(**{"springs.break_at_strain": [0.1, 0.2]}))
    with pytest.raises(ScenarioError, match=r"object.look_every: .*looks are too many"):
        resolve(free(**{"object": {"kind": "springs", "look_every": 1e-12}, "springs.break_at_force": 1.0}))
    with pytest.raises(ScenarioError, match=r"springs.break_at_force"):
        free(**{"springs.break_at_force": 0.0})
