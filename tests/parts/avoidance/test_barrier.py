import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from drake_formation import ScenarioError, load_scenario, metrics, simulate
from drake_formation.analysis import certify
from drake_formation.parts.avoidance.barrier_function import barrier_force, smooth_barrier
from drake_formation.scenario import resolve, with_overrides
from drake_formation.simulation.run import PreparedRun

coordinates = st.floats(-3, 3)
pairs = st.tuples(coordinates, coordinates)
forces = st.tuples(st.floats(-200, 200), st.floats(-200, 200))
radii = st.just(0.0) | st.floats(0.05, 1)
discs = st.lists(st.tuples(coordinates, coordinates, radii).map(list), min_size=1, max_size=4)
MASS, CLEARANCE, RATE, SHARPNESS = NUMBERS = (40.0, 0.3, 1.5, 10.0)


def spare(position, velocity, disc):
    """b = h + ḣ/λ of one obstacle."""
    away = np.subtract(position, disc[:2])
    distance = np.linalg.norm(away)
    return distance - disc[2] - CLEARANCE + away @ velocity / distance / RATE


def growth(position, velocity, force, around):
    """Ḃ, by differences along the motion under a force."""
    step, acceleration = 1e-5, np.divide(force, MASS)

    def ahead(time):
        place = np.add(position, np.multiply(time, velocity)) + time**2 / 2 * acceleration
        return smooth_barrier(tuple(place), tuple(velocity + time * acceleration), around, *NUMBERS[1:])[0]

    return (ahead(step) - ahead(-step)) / (2 * step)


def clear(position, around):
    return all(np.hypot(*np.subtract(position, disc[:2])) > disc[2] + 0.05 for disc in around)


@given(pairs, pairs, discs)
def test_the_smooth_minimum_is_below_all_by_no_more_than_promised(position, velocity, around):
    assume(clear(position, around))
    least = min(spare(position, velocity, disc) for disc in around)
    barrier, _, _ = smooth_barrier(position, velocity, around, *NUMBERS[1:])
    assert least - np.log(len(around)) / SHARPNESS - 1e-9 <= barrier <= least + 1e-9


@given(pairs, pairs, forces, discs)
def test_with_the_correction_the_barrier_falls_no_faster_than_allowed(position, velocity, others, around):
    assume(clear(position, around))
    barrier, slope, _ = smooth_barrier(position, velocity, around, *NUMBERS[1:])
    assume(np.hypot(*slope) > 1e-2)
    force = np.add(others, barrier_force(position, velocity, others, around, *NUMBERS))
    assert growth(position, velocity, force, around) + RATE * barrier >= -1e-4 * (1 + np.hypot(*force))


@given(pairs, pairs, forces, discs)
def test_it_takes_no_more_force_than_the_others_and_the_speed_give_cause_for(position, velocity, others, around):
    assume(clear(position, around))
    assume(smooth_barrier(position, velocity, around, *NUMBERS[1:])[0] >= 0)
    force = barrier_force(position, velocity, others, around, *NUMBERS)
    assert np.hypot(*force) <= (np.hypot(*others) + MASS * RATE * np.hypot(*velocity)) * (1 + 1e-9) + 1e-9


@given(pairs, pairs, forces, discs)
@settings(max_examples=20)
def test_the_closed_form_is_the_least_force(position, velocity, others, around):
    assume(clear(position, around))
    barrier, (gx, gy), gain = smooth_barrier(position, velocity, around, *NUMBERS[1:])
    assume(np.hypot(gx, gy) > 0.1)

    def slack(force):
        push = (gx * (force[0] + others[0]) + gy * (force[1] + others[1])) / MASS
        return gain + push + RATE * (gx * velocity[0] + gy * velocity[1]) + RATE**2 * barrier

    found = minimize(
        lambda f: f @ f / MASS**2, np.zeros(2), jac=lambda f: 2 * f / MASS**2,
        constraints={"type": "ineq", "fun": slack}, method="SLSQP", options={"ftol": 1e-14},
    )  # fmt: skip
    assume(found.success)
    expected = barrier_force(position, velocity, others, around, *NUMBERS)
    np.testing.assert_allclose(found.x, expected, rtol=1e-4, atol=1e-2)


def test_what_is_safe_is_left_alone():
    assert barrier_force((5.0, 0.0), (0.1, 0.0), (3.0, 4.0), [[0.0, 0.0, 0.5]], *NUMBERS) == (0.0, 0.0)


def test_one_obstacle_dead_ahead_is_approached_as_the_two_poles_say():
    force = barrier_force((2.0, 0.0), (-1.0, 0.0), (-500.0, 0.0), [[0.0, 0.0, 0.5]], *NUMBERS)
    acceleration = (force[0] - 500.0) / MASS
    assert acceleration + 2 * RATE * -1.0 + RATE**2 * (2.0 - 0.5 - CLEARANCE) == pytest.approx(0.0, abs=1e-12)
    assert force[1] == 0.0


def test_midway_between_two_obstacles_there_is_no_direction_to_push_and_none_is_needed():
    around = [[1.0, 0.0, 0.2], [-1.0, 0.0, 0.2]]
    assert barrier_force((0.0, 0.0), (0.0, 1.0), (0.0, 100.0), around, *NUMBERS) == (0.0, 0.0)


FAST = {
    "formation": {"shape": "line", "robots": 2, "side": 1.0},
    "robots.start": {"centre": [0.0, 0.0]},
    "springs.stiffness": 40.0,
    "tracking": {"Q": 1e4},
    "consensus.delta": 100.0,
    "transport": {"goal": [6.0, 0.0], "duration": 3.0},
    "aggregation.duration": 0.0,
}


def scene(obstacles, **changes):
    """Two robots that hurry to a goal, and obstacles in between."""
    avoidance = {"kind": "barrier", "rate": 3.0, "obstacles": obstacles, **changes}
    return load_scenario("line", overrides={**FAST, "avoidance": avoidance})


places = st.lists(
    st.tuples(st.floats(1.2, 6.5), st.floats(-1.5, 1.5), st.floats(0.0, 0.6)), min_size=3, max_size=3
)  # fmt: skip


@pytest.fixture(scope="module")
def prepared():
    return PreparedRun(scene([{"position": [9.0, k], "radius": 0.0} for k in (0.0, 1.0, 2.0)]), engine="compiled")


@pytest.mark.slow
@given(places, st.sampled_from([0.1, 0.3]), st.sampled_from([1.0, 3.0, 10.0]))
@settings(max_examples=25, deadline=None)
def test_no_scene_brings_a_robot_nearer_than_asked(prepared, obstacles, clearance, rate):
    around = [{"position": [x, y], "radius": radius} for x, y, radius in obstacles]
    try:
        scenario = scene(around, clearance=clearance, rate=rate)
    except ScenarioError:
        assume(False)
    series = prepared.run(scenario)
    assert series["clearance"].min() >= clearance - 1e-5


@pytest.mark.slow
def test_without_it_the_same_robots_come_too_near():
    around = [{"position": [3.0, 0.5], "radius": 0.3}]
    free = load_scenario("line", overrides={**FAST, "avoidance": {"obstacles": around, "gain": 1e-3, "range": 0.2}})
    assert simulate(free, engine="compiled")["clearance"].min() < 0.25
    kept = simulate(scene(around), engine="compiled")["clearance"].min()
    assert 0.3 - 1e-5 <= kept < 0.4


@pytest.mark.slow
@pytest.mark.parametrize("tracking", [{"kind": "lqr_discrete", "Q": 1e4, "period": 0.2}, {"kind": "lqi"}])
def test_it_keeps_the_clearance_whatever_controller_it_corrects(tracking):
    scenario = with_overrides(scene([{"position": [3.0, 0.5], "radius": 0.3}]), {"tracking": tracking})
    kept = simulate(scenario, engine="compiled")["clearance"].min()
    assert kept >= 0.3 - 1e-5


def test_it_is_felt_in_transport_only():
    """While they gather, a robot passes through what is no obstacle before the hand-off."""
    changes = {"robots.start": [[0.0, -0.5], [3.0, 0.5]], "aggregation.duration": 4.0, "transport.duration": 0.5}
    scenario = with_overrides(scene([{"position": [2.5, 0.5], "radius": 0.2}], clearance=0.2), changes)
    assert simulate(scenario, engine="compiled")["clearance"].min() < 0.0


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    scenario = scene([{"position": [3.0, 0.5], "radius": 0.3}, {"position": [3.5, -0.8]}])
    found, blocks = (simulate(scenario, engine=name)["position"].values[-1] for name in (engine, "blocks"))
    np.testing.assert_allclose(found, blocks, rtol=0, atol=1e-4)


def test_a_start_within_the_clearance_is_refused_with_its_place():
    with pytest.raises(ScenarioError, match=r"avoidance.clearance: robot 1 begins at .* less to the obstacles"):
        scene([{"position": [0.0, -0.7], "radius": 0.1}])


def test_the_analysis_is_of_a_formation_that_feels_no_obstacle():
    certificate = certify(scene([{"position": [3.0, 0.5], "radius": 0.3}]))
    assert certificate.stable
    assert not len(resolve(certificate.formation.scenario).obstacles)
    assert any(line.startswith("avoidance") for line in certificate.to_dict()["not_covered"])


WEAK = {"wheel_force_limit": 20.0}


@pytest.mark.parametrize("robots", [{"drag": 3.0}, {"kind": "omnidirectional"} | WEAK, {"kind": "unicycle"} | WEAK])
def test_a_robot_that_its_forces_alone_do_not_move_is_refused(robots):
    changes = {f"robots.{name}": value for name, value in robots.items()}
    changes["avoidance"] = {"kind": "barrier", "obstacles": [{"position": [9.0, 9.0]}]}
    with pytest.raises(ScenarioError, match=r"robots\.(drag|wheel_force_limit): the barrier takes robot 1 for a mass"):
        load_scenario("line", overrides=changes)


@pytest.mark.parametrize(
    "obstacle",
    [
        {"kind": "segment", "ends": [[6.0, 5.5], [7.0, 5.5]]},
        {"position": [6.0, 5.5], "velocity": [0.1, 0.0]},
    ],
)
def test_what_the_proof_does_not_cover_is_refused(obstacle):
    with pytest.raises(ScenarioError, match=r"avoidance.obstacles.1: the barrier keeps its clearance from circles at"):
        load_scenario(
            "line", overrides={"avoidance": {"kind": "barrier", "obstacles": [{"position": [9, 9]}, obstacle]}}
        )


def test_the_clearance_is_the_footprints():
    obstacle = {"position": [6.0, 5.05], "radius": 0.1}
    found = []
    for radius, footprint in ((0.3, 0.0), (0.1, 0.2)):
        overrides = {"avoidance": {"kind": "barrier", "obstacles": [obstacle | {"radius": radius}]}}
        scenario = load_scenario("line", overrides=overrides | {"robots.radius": footprint, "transport.duration": 20.0})
        found.append(simulate(scenario, engine="blocks"))
    np.testing.assert_allclose(found[0]["position"], found[1]["position"], rtol=0, atol=1e-9)
    assert metrics(found[1]).min_clearance_m == pytest.approx(metrics(found[0]).min_clearance_m)
