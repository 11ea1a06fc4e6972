"""The store runs each scenario once and finds it again."""

import pytest
import xarray as xr

from drake_formation import load_scenario, simulate, with_overrides
from drake_formation.paper.store import Store

SHORT = load_scenario("line", overrides={"aggregation.duration": 1.0, "transport.duration": 2.0})
OTHER = with_overrides(SHORT, {"springs.stiffness": 2.0})


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path / "runs")


def test_a_run_is_kept_and_equals_a_fresh_one(store):
    xr.testing.assert_identical(store[SHORT], simulate(SHORT, engine="compiled"))
    changed = store.path(SHORT).stat().st_mtime_ns
    assert store[SHORT].sizes["time"] > 0
    assert store.path(SHORT).stat().st_mtime_ns == changed


def test_every_change_of_the_scenario_is_another_run(store):
    assert store.path(SHORT) != store.path(OTHER)
    assert store.path(SHORT) == store.path(with_overrides(OTHER, {"springs.stiffness": 1.45}))


def test_only_what_is_missing_is_run_once_each_on_all_processors(store):
    store[SHORT]
    calls = []
    assert store.missing([SHORT, OTHER, OTHER]) == [OTHER]
    store.run([SHORT, OTHER, OTHER], lambda: calls.append(1))
    assert len(calls) == 1
    assert not store.missing([SHORT, OTHER])
    assert len(list(store.path(OTHER).parent.iterdir())) == 2


def test_the_longest_run_comes_first(store):
    stiff = load_scenario("octagon", overrides={"springs.stiffness": 3e4})
    assert store.missing([SHORT, stiff])[0] == stiff


def test_more_runs_than_the_workers_may_make_are_made_all_the_same(store, monkeypatch):
    monkeypatch.setattr("drake_formation.paper.store.RUNS_PER_WORKER", 1)
    runs = [with_overrides(SHORT, {"springs.stiffness": float(k)}) for k in range(5)]
    calls = []
    store.run(runs, lambda: calls.append(1))
    assert len(calls) == 5
    assert not store.missing(runs)
