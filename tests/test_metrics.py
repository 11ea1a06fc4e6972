import json

import numpy as np
import pytest
import xarray as xr

from drake_formation.metrics import Metrics, length, metrics

VECTOR = ("time", "robot", "axis")
TIMES = [0.0, 1.0, 2.0, 3.0, 5.0]


def result(springs=1, obstacles=1, **changes):
    """Two robots: one sample of aggregation with huge numbers, then four of transport, 10 m to the goal."""
    still = np.zeros((5, 2, 2))
    variables = {
        "phase": ("time", [0, 1, 1, 1, 1]),
        "position": (VECTOR, np.array([[0.0, -0.5], [0.0, 0.5]]) + [[[x, 0.0]] for x in (-9.0, 0.0, 9.0, 9.9, 10.0)]),
        "slot": (("robot", "axis"), [[0.0, -0.5], [0.0, 0.5]]),
        "goal": ("axis", [10.0, 0.0]),
        "aggregation_centre": ("axis", [0.0, 0.0]),
        "deviation": (VECTOR, still),
        "consensus_error": (VECTOR, still),
        "control_force": (VECTOR, still),
        "clearance": (("time", "robot", "obstacle"), np.ones((5, 2, obstacles))),
        "spring_length": (("time", "spring"), np.ones((5, springs))),
        "rest_length": ("spring", np.ones(springs)),
    }
    return xr.Dataset(variables | changes, {"time": TIMES})


def vectors(*values, before=999.0):
    """Vectors of both robots at five samples, zero but for (time index, robot index, vector)."""
    array = np.zeros((5, 2, 2))
    array[0] = before
    for time, robot, vector in values:
        array[time, robot] = vector
    return VECTOR, array


def test_the_tracking_error_is_the_largest_deviation_of_each_robot():
    deviation = vectors((1, 0, [0.03, 0.04]), (4, 1, [0.0, -0.2]), (3, 1, [0.1, 0.1]), before=np.nan)
    assert metrics(result(deviation=deviation)).tracking_error_m == pytest.approx([0.05, 0.2])


def test_the_consensus_error_is_the_largest_of_any_robot():
    errors = vectors((1, 0, [0.3, -0.4]), (2, 1, [0.0, 0.2]))
    assert metrics(result(consensus_error=errors)).consensus_error_m == pytest.approx(0.5)


def test_the_peak_force_is_the_largest_of_any_robot():
    forces = vectors((1, 0, [3.0, 4.0]), (4, 1, [-5.0, 12.0]))
    assert metrics(result(control_force=forces)).peak_force_n == pytest.approx(13)


def test_the_clearance_is_the_least_of_any_robot_to_any_obstacle():
    clearance = np.full((5, 2, 3), 2.0)
    clearance[0] = 0.1
    clearance[3, 1, 2] = 0.7
    measured = metrics(result(obstacles=3, clearance=(("time", "robot", "obstacle"), clearance)))
    assert measured.min_clearance_m == 0.7


@pytest.mark.parametrize("length", [1.5, 2.5])
def test_the_strain_is_the_largest_share_of_any_spring_longer_or_shorter(length):
    lengths = np.array([[9.0, 9.0], [1.0, 2.0], [1.1, 2.0], [1.0, length], [1.0, 2.0]])
    measured = metrics(result(springs=2, spring_length=(("time", "spring"), lengths), rest_length=("spring", [1, 2])))
    assert measured.max_spring_strain == pytest.approx(0.25)


def test_without_springs_or_obstacles_there_is_nothing_to_measure():
    measured = metrics(result(springs=0, obstacles=0))
    assert measured.max_spring_strain is None
    assert measured.min_clearance_m is None


def moved(*distances):
    """Both robots in formation, so far from the goal."""
    return VECTOR, np.array([[0.0, -0.5], [0.0, 0.5]]) + [[[10.0 - x, 0.0]] for x in distances]


@pytest.mark.parametrize(
    ("distances", "settled"),
    [
        pytest.param((9.0, 10.0, 0.21, 0.19, 0.0), 2.0, id="from the first near sample, counted from the hand-off"),
        pytest.param((9.0, 10.0, 0.1, 0.3, 0.0), 4.0, id="not before the last time it is far"),
        pytest.param((9.0, 0.1, 0.1, 0.1, 0.0), 0.0, id="at once"),
        pytest.param((9.0, 10.0, 1.0, 0.1, 0.3), None, id="not when it is far at the end"),
        pytest.param((0.0, 10.0, 10.0, 10.0, 10.0), None, id="never"),
    ],
)
def test_a_run_has_settled_when_it_stays_within_two_percent_of_the_way(distances, settled):
    assert metrics(result(position=moved(*distances))).settling_time_s == settled


def test_a_run_has_settled_when_its_last_robot_has():
    _, position = moved(9.0, 10.0, 0.0, 0.0, 0.0)
    position[2:4, 1, 1] += 0.3
    assert metrics(result(position=(VECTOR, position))).settling_time_s == 4.0


def test_a_result_without_transport_cannot_be_measured():
    with pytest.raises(ValueError, match="no transport"):
        metrics(result(phase=("time", [0] * 5)))


def test_metrics_are_plain_numbers():
    measured = metrics(result())
    assert Metrics(**json.loads(json.dumps(measured.to_dict()))) == measured


def test_length_keeps_units():
    vector = xr.DataArray([[3.0, 4.0]], dims=("time", "axis"), attrs={"units": "m"})
    assert length(vector).values.tolist() == [5.0]
    assert length(vector).attrs == {"units": "m"}
