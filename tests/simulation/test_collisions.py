"""Contacts as they begin, between samples too."""

import numpy as np
import pytest

from drake_formation import load_scenario
from drake_formation.simulation.choice import Choice
from drake_formation.simulation.collisions import collisions
from drake_formation.simulation.series import Series

BASE = {
    "aggregation.duration": 0.0,
    "robots.start": [[0.0, 0.0], [0.0, 5.0]],
    "transport": {"goal": [50.0, 0.0], "duration": 4.0},
    "robots.radius": [0.5, 0.25],
}


def moving(path, *obstacles, steps=5, phase=1, **changes):
    """What is found where robots move evenly: positions at the beginning and velocities, two of each."""
    places, velocities = np.array(path, dtype=float)
    scenario = load_scenario("line", overrides=BASE | {"avoidance.obstacles": list(obstacles)} | changes)
    times = np.linspace(0.0, 4.0, steps)
    speed = np.broadcast_to(velocities, (steps, 2, 2))
    arrays = {
        "time": times,
        "phase": np.broadcast_to(phase, steps),
        "position": places + times[:, None, None] * velocities,
        "velocity": speed,
        "acceleration": np.zeros_like(speed),
    }
    return collisions(Series(arrays, scenario, Choice("blocks", "")))


ALONG = [[[0.0, 0.0], [0.0, 5.0]], [[1.0, 0.0], [0.0, 0.0]]]


@pytest.mark.parametrize("steps", [2, 5, 40])
def test_robots_that_pass_each_other_touch_as_often_as_they_meet(steps):
    towards = [[[0.0, 0.0], [4.0, 0.6]], [[1.0, 0.0], [-1.0, 0.0]]]
    (found,) = moving(towards, steps=steps)
    apart = np.sqrt(0.75**2 - 0.6**2)
    assert found.time == pytest.approx((4.0 - apart) / 2.0, abs=1e-5)
    assert (found.who, found.sentence) == ((1, 2), "robot 1 touches robot 2")
    first = np.array([found.time, 0.0])
    assert np.hypot(*(np.array(found.place) - first)) == pytest.approx(0.5, abs=1e-4)
    assert moving(towards, steps=steps, **{"robots.radius": [0.3, 0.25]}) == []


def test_points_do_not_touch_points():
    assert moving([[[0.0, 0.0], [4.0, 0.0]], [[1.0, 0.0], [-1.0, 0.0]]], **{"robots.radius": 0.0}) == []


@pytest.mark.parametrize("steps", [2, 5, 40])
def test_a_corner_is_touched_where_the_footprint_meets_it(steps):
    wedge = {"kind": "polygon", "vertices": [[2.0, 0.3], [3.0, 4.0], [1.0, 4.0]]}
    (found,) = moving(ALONG, wedge, steps=steps)
    assert (found.time, *found.place) == pytest.approx((1.6, 2.0, 0.3), abs=1e-4)
    assert (found.who, found.sentence) == ((1,), "robot 1 touches obstacle 1")


def test_a_graze_of_a_hair_between_two_samples_is_found():
    ball = {"position": [2.0, 0.7], "radius": 0.2001}
    (found,) = moving(ALONG, ball, steps=2)
    assert found.time == pytest.approx(2.0, abs=0.02)
    assert moving(ALONG, ball | {"radius": 0.1999}, steps=2) == []


def test_one_that_comes_and_goes_is_touched_twice():
    """It moves up to the robot at rest, away, and up again, all within one step."""
    places = [(0.5, 2.45), (1.0, 1.0), (1.5, 2.45), (2.0, 1.0), (3.5, 1.5)]
    points = [{"time": 0.1 + time, "position": [y, 0.0]} for time, y in places]
    comes = {"position": [1.0, 0.0], "radius": 0.1, "waypoints": points, "start": 0.1}
    found = moving([[[3.0, 0.0], [0.0, 5.0]], [[0.0, 0.0], [0.0, 0.0]]], comes, steps=2)
    assert [collision.time for collision in found] == pytest.approx([0.1 + 1.4 / 2.9, 1.1 + 1.4 / 2.9], abs=1e-4)
    assert [collision.place for collision in found] == [pytest.approx((2.5, 0.0), abs=1e-4)] * 2


def test_what_touches_from_the_start_does_so_then_and_obstacles_only_while_the_object_is_carried():
    over = {"position": [0.0, 0.3], "radius": 0.1}
    free = {"position": [30.0, 30.0]}
    with_one = {"robots.start": [[0.0, 9.0], [0.0, 5.0]], "aggregation.duration": 1.0}
    assert [found.time for found in moving(ALONG, over, **with_one)] == [0.0]
    assert moving(ALONG, over, free, phase=0, **with_one) == []
