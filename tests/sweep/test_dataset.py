"""The dataset holds every value at its place, and what a run has not is NaN."""

import math

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from sweep.quick import quick_sweep

from drake_formation.sweep import dataset as module
from drake_formation.sweep import load_sweep
from drake_formation.sweep.dataset import blocks, write_dataset, write_failures
from drake_formation.sweep.store import Store
from drake_formation.sweep.work import Outcome

IDENTITY = {"sweep": "x", "engine": "compiled", "drake": "1.51.1", "drake-formation": "0.1.0"}
AXES = [
    {"path": "springs.stiffness", "linspace": [1.0, 4.0, 4]},
    {"kind": "list", "points": [{"label": "a", "set": {"consensus.delta": 1.0}}, {"label": "b", "set": {}}]},
    {"kind": "zip", "values": {"avoidance.gain": [1.0, 2.0, 3.0], "avoidance.range": [4.0, 5.0, 6.0]}},
]


@given(st.lists(st.integers(1, 6), min_size=1, max_size=4), st.integers(1, 400))
def test_blocks_cover_every_point_once_in_order(shape, most):
    shape = tuple(shape)
    numbers = np.arange(math.prod(shape)).reshape(shape)
    covered = []
    for place, first, size in blocks(shape, most):
        block = numbers[place]
        assert block.size == math.prod(size) <= max(most, 1)
        assert block.ravel()[0] == first
        covered.extend(block.ravel())
    assert covered == list(range(math.prod(shape)))


def written(folder, sweep, outcomes):
    with Store(folder, IDENTITY) as store:
        store.add(outcomes)
        write_dataset(folder / "sweep.nc", sweep, store, IDENTITY)
    return xr.load_dataset(folder / "sweep.nc")


def outcome(index, robots=2, samples=3):
    values = {"peak_force_n": np.array(float(index)), "tracking_error_m": index + np.arange(robots) / 10}
    position = index + np.arange(samples * robots * 2).reshape(samples, robots, 2) / 100
    return Outcome(index, None, values | {"position": position})


@pytest.mark.parametrize("numbers", [1, 100, 10**6])
def test_values_are_at_their_places_whatever_the_blocks(tmp_path, monkeypatch, numbers):
    monkeypatch.setattr(module, "_BLOCK", numbers)
    sweep = load_sweep(quick_sweep(*AXES, trajectories={"variables": ["position"], "every": 0.5}))
    dataset = written(tmp_path, sweep, [outcome(k) for k in range(len(sweep))])
    assert dataset["position"].dims == ("stiffness", "point", "case", "time", "robot", "axis")
    for index in range(len(sweep)):
        here = dataset.isel(dict(zip(("stiffness", "point", "case"), sweep.positions(index), strict=True)))
        for name, value in outcome(index).values.items():
            np.testing.assert_array_equal(here[name], value)


def test_coordinates_units_and_where_it_came_from(tmp_path):
    sweep = load_sweep(quick_sweep(*AXES, trajectories={"variables": ["position"], "every": 0.5}))
    dataset = written(tmp_path, sweep, [outcome(0)])
    assert dataset["stiffness"].values.tolist() == [1.0, 2.0, 3.0, 4.0]
    assert dataset["point"].values.tolist() == ["a", "b"]
    assert set(dataset.coords) == {"stiffness", "point", "case", "gain", "range", "time", "robot", "axis"}
    assert dataset["gain"].dims == dataset["range"].dims == ("case",)
    assert dataset["time"].values.tolist() == [0.0, 0.5, 1.0]
    assert dataset["robot"].values.tolist() == [1, 2]
    assert dataset["axis"].values.tolist() == ["x", "y"]
    assert dataset["peak_force_n"].attrs["units"] == "N"
    assert dataset["position"].attrs["units"] == "m"
    assert dataset["stiffness"].attrs["units"] == "N/m"
    assert dataset.attrs["drake_formation_version"] == "0.1.0"
    assert dataset.attrs["engine"] == "compiled"
    assert dataset.sel(stiffness=2.0, point="b")["status"].shape == (3,)


def test_what_a_run_has_not_is_nan(tmp_path):
    sweep = load_sweep(quick_sweep(*AXES[:1]))
    runs = [outcome(0), outcome(1, robots=3, samples=2), Outcome(2, "it broke")]
    dataset = written(tmp_path, sweep, runs)
    assert dataset["position"].shape == (4, 3, 3, 2)
    assert dataset["position"].isnull().sum(["robot", "time", "axis"]).values.tolist() == [6, 6, 18, 18]
    assert dataset["status"].values.tolist() == [1, 1, 2, 0]
    assert dataset["error"].values.tolist() == ["", "", "it broke", ""]


def test_a_sweep_of_nothing_but_failures_has_their_errors(tmp_path):
    sweep = load_sweep(quick_sweep(*AXES[:1]))
    dataset = written(tmp_path, sweep, [Outcome(k, f"error {k}") for k in range(4)])
    assert set(dataset.data_vars) == {"status", "error"}
    assert dataset["error"].values.tolist() == [f"error {k}" for k in range(4)]


def test_the_table_of_failures_is_gone_with_the_failures(tmp_path):
    sweep = load_sweep(quick_sweep(*AXES[:1]))
    with Store(tmp_path, IDENTITY) as store:
        store.add([Outcome(1, "it, say, “broke”")])
        write_failures(tmp_path, sweep, store)
        assert (tmp_path / "failures.csv").read_text(encoding="utf-8").splitlines()[1].startswith("1,")
        store.add([Outcome(1, None)])
        write_failures(tmp_path, sweep, store)
        assert not (tmp_path / "failures.csv").exists()
