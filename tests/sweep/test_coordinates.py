import numpy as np
import pytest
from sweep.quick import quick_sweep

from drake_formation.scenario import ScenarioError
from drake_formation.sweep import load_sweep
from drake_formation.sweep.coordinates import coordinates, dimensions


def labelled(*axes, **others):
    sweep = load_sweep(quick_sweep(*axes, **others))
    return dimensions(sweep.axes), {each.name: each for each in coordinates(sweep.axes)}


def test_a_grid_axis_is_named_after_its_field_and_has_its_values():
    names, found = labelled({"path": "springs.stiffness", "logspace": [1.0, 100.0, 3]})
    assert names == ("stiffness",)
    np.testing.assert_allclose(found["stiffness"].values, [1.0, 10.0, 100.0])
    assert found["stiffness"].attributes == {
        "kind": "grid",
        "path": "springs.stiffness",
        "units": "N/m",
        "long_name": "stiffness k_ij",
        "scale": "log",
    }


def test_a_name_of_the_users_own_comes_first():
    names, found = labelled({"path": "springs.stiffness", "name": "k", "values": [1.0]})
    assert names == ("k",)
    assert list(found) == ["k"]


def test_fields_of_one_name_are_told_apart_by_their_paths():
    axes = [{"path": f"{part}.graph", "values": ["path", [[1, 2]]]} for part in ("springs", "consensus")]
    names, found = labelled(*axes)
    assert names == ("springs.graph", "consensus.graph")
    assert list(found["springs.graph"].values) == ["path", "[[1, 2]]"]


def test_a_field_named_as_a_part_of_the_dataset_keeps_its_path():
    cases = {"kind": "zip", "name": "stiffness", "values": {"springs.stiffness": [1.0, 2.0]}}
    names, found = labelled(cases)
    assert names == ("stiffness",)
    assert found["springs.stiffness"].dimension == "stiffness"


def test_positions_in_lists_are_part_of_the_name():
    names, found = labelled({"path": "robots.start.0.1", "values": [4.0, 5.0]}, set={"robots.start": [[0, 0], [1, 1]]})
    assert names == ("start.0.1",)
    assert found["start.0.1"].attributes["units"] == "m"


def test_values_that_are_not_numbers_are_coordinates_as_text_or_by_label():
    obstacles = [[], [{"position": [9.0, 9.0]}]]
    _, found = labelled({"path": "avoidance.obstacles", "values": obstacles})
    assert list(found["obstacles"].values) == ["[]", '[{"position": [9.0, 9.0]}]']
    _, found = labelled({"path": "avoidance.obstacles", "values": obstacles, "labels": ["none", "one"]})
    assert list(found["obstacles"].values) == ["none", "one"]


def test_whole_numbers_stay_whole_and_mixed_ones_become_real():
    assert labelled({"path": "avoidance.gain", "values": [1, 2]})[1]["gain"].values.dtype == np.int64
    assert labelled({"path": "avoidance.gain", "values": [1, 2.5]})[1]["gain"].values.dtype == np.float64
    assert labelled({"path": "tracking.feed_forward", "values": [True, False]})[1]["feed_forward"].values[0] == "true"


def test_zip_and_random_have_a_coordinate_for_each_field_along_one_dimension():
    names, found = labelled(
        {"kind": "zip", "values": {"springs.stiffness": [1.0, 2.0], "springs.damping": [3.0, 4.0]}},
        {"kind": "random", "seed": 1, "count": 3, "draw": {"robots.mass": {"uniform": [30.0, 50.0]}}},
    )
    assert names == ("case", "sample")
    assert list(found["case"].values) == [1, 2]
    assert found["stiffness"].dimension == found["damping"].dimension == "case"
    assert (found["mass"].dimension, len(found["mass"].values)) == ("sample", 3)


def test_a_list_has_its_labels_and_the_fields_that_all_its_points_set():
    points = [
        {"label": "a", "set": {"springs.stiffness": 1.0, "robots.mass": 30.0}},
        {"label": "b", "set": {"springs.stiffness": 2.0}},
    ]
    names, found = labelled({"kind": "list", "points": points})
    assert names == ("point",)
    assert list(found["point"].values) == ["a", "b"]
    assert list(found["stiffness"].values) == [1.0, 2.0]
    assert "mass" not in found


def test_a_name_that_a_fields_coordinate_has_is_refused():
    # The zip's name makes its field go by its path, which is the list's name.
    axes = [
        {"kind": "zip", "name": "delta", "values": {"consensus.delta": [0.0, 1.0]}},
        {"kind": "list", "name": "consensus.delta", "points": [{"label": "a", "set": {"robots.mass": 30.0}}]},
    ]
    with pytest.raises(ScenarioError, match=r"axes\.1\.name: taken by another part of the dataset"):
        labelled(*axes)


def test_whole_numbers_beyond_64_bits_are_told_apart_as_text():
    seeds = {"path": "robots.start.random.seed", "values": [2**70, 2**70 + 1]}
    _, found = labelled(seeds, set={"robots.start": {"random": {"about": [0.0, 0.0], "spread": 2.0}}})
    assert list(found["seed"].values) == [str(2**70), str(2**70 + 1)]
