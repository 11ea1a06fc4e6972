"""The store runs each scenario once and finds it again."""

import os

import pytest
import xarray as xr

from drake_formation import load_scenario, simulate, with_overrides
from drake_formation.paper.measured import measured
from drake_formation.paper.store import Store
from drake_formation.sweep import Processes, SweepStoppedError
from drake_formation.sweep.work import CODE, versions

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


@pytest.mark.slow
def test_only_what_is_missing_is_run_once_each_on_all_processors(store):
    store[SHORT]
    calls = []
    missing = store.missing([SHORT, OTHER, OTHER])
    assert missing == {store.path(OTHER): OTHER}
    store.run(missing, lambda: calls.append(1))
    assert len(calls) == 1
    assert not store.missing([SHORT, OTHER])
    assert len(list(store.path(OTHER).parent.glob("*.nc"))) == 2


def test_figures_are_kept_without_the_result_and_are_those_of_the_run(store):
    (path,) = store.missing([], [SHORT])
    store.run({path: SHORT}, lambda: None)
    assert [file.suffix for file in path.parent.iterdir()] == [".json"]
    assert dict(store.measured(SHORT)) == dict(measured(SHORT, simulate(SHORT, engine="compiled")))
    assert not store.missing([], [SHORT])


def test_a_result_brings_its_figures(store):
    assert list(store.missing([SHORT], [SHORT])) == [store.path(SHORT)]
    store[SHORT]
    assert not store.missing([], [SHORT])


@pytest.mark.parametrize("damage", ["", "{", "[1]"])
def test_damaged_figures_are_made_anew(store, damage):
    wanted = dict(store.measured(SHORT))
    (path,) = store.path(SHORT).parent.iterdir()
    path.write_text(damage, encoding="utf-8")
    assert dict(store.measured(SHORT)) == wanted


def test_the_longest_run_comes_first(store):
    stiff = load_scenario("octagon", overrides={"springs.stiffness": 3e4})
    assert next(iter(store.missing([SHORT, stiff]).values())) == stiff


@pytest.mark.slow
def test_more_runs_than_the_workers_may_make_are_made_all_the_same(store, monkeypatch):
    monkeypatch.setattr("drake_formation.paper.store.RUNS_PER_WORKER", 1)
    runs = [with_overrides(SHORT, {"springs.stiffness": float(k)}) for k in range(5)]
    calls = []
    store.run(store.missing(runs), lambda: calls.append(1))
    assert len(calls) == 5
    assert not store.missing(runs)


def test_other_code_makes_the_runs_anew_beside_the_earlier_ones(store, monkeypatch):
    store[SHORT]
    before = store.path(SHORT)
    monkeypatch.setattr("drake_formation.paper.store.versions", lambda: versions() | {CODE: "other"})
    assert store.path(SHORT) != before
    assert list(store.missing([SHORT]).values()) == [SHORT]
    assert before.exists()


@pytest.mark.parametrize(
    "damage", [lambda whole: b"", lambda whole: whole[: len(whole) // 2], lambda whole: b"no" * 999]
)
def test_a_damaged_result_is_made_anew(store, damage):
    wanted = store[SHORT]
    path = store.path(SHORT)
    path.write_bytes(damage(path.read_bytes()))
    xr.testing.assert_identical(store[SHORT], wanted)
    xr.testing.assert_identical(xr.load_dataset(path), wanted)


DIVERGING = with_overrides(
    SHORT,
    {
        "consensus.delta": 1e6,
        "simulator.use_error_control": False,
        "simulator.max_step_size": 0.5,
        "transport.duration": 60.0,
    },
)


def test_a_run_that_fails_in_a_worker_stops_the_study_in_words(store):
    with pytest.raises(SweepStoppedError, match="the run stopped at t = "):
        store.run(store.missing([DIVERGING]), lambda: None)
    assert not list(store.path(SHORT).parent.iterdir())


@pytest.mark.parametrize(("deaths", "kept"), [(1, True), (2, False)])
def test_a_run_whose_worker_is_killed_is_made_once_more(store, monkeypatch, deaths, kept):
    call, calls = Processes.call, []

    def deadly(pool, function, *arguments):
        calls.append(arguments)
        if len(calls) <= deaths:
            return call(pool, os._exit, 7)
        return call(pool, function, *arguments)

    monkeypatch.setattr(Processes, "call", deadly)
    if kept:
        store.run(store.missing([SHORT]), lambda: None)
        assert not store.missing([SHORT])
    else:
        with pytest.raises(SweepStoppedError, match="the worker process ended with exit status 7"):
            store.run(store.missing([SHORT]), lambda: None)
