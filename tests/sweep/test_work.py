import pickle

import numpy as np
import pytest
from sweep.quick import FAILING, quick_sweep

from drake_formation.sources import source_hash
from drake_formation.sweep import SweepError, load_sweep
from drake_formation.sweep.work import CODE, Chunk, Task, run_chunk, versions


def chunk(sweep, *indices, **changes):
    task = Task(
        **{"base": sweep.base.data, "engine": "compiled", "trajectories": None, "versions": versions()} | changes
    )
    return Chunk(task, tuple((index, sweep.overrides(index)) for index in indices))


def test_a_chunk_gives_an_outcome_for_each_of_its_points(sweep):
    report = run_chunk(chunk(sweep, 5, 2))
    assert [outcome.index for outcome in report.outcomes] == [5, 2]
    assert all(outcome.error is None for outcome in report.outcomes)
    assert report.seconds > 0


def test_failed_runs_say_why_and_leave_the_others_alone():
    sweep = load_sweep(quick_sweep(FAILING))
    sound, wrong, light, diverging = run_chunk(chunk(sweep, 0, 1, 2, 3)).outcomes
    assert sound.error is light.error is None
    assert wrong.error.startswith("robots.mass")
    assert "the run stopped at t = " in diverging.error
    assert not wrong.values
    assert not diverging.values


def test_what_no_one_thought_of_is_the_runs_own_failure(sweep, monkeypatch):
    def broken(*_):
        raise SystemExit("Drake demands")

    monkeypatch.setattr("drake_formation.sweep.runner.Runner.measure", broken)
    (outcome,) = run_chunk(chunk(sweep, 0)).outcomes
    assert outcome.error == "SystemExit: Drake demands"


def test_an_error_is_text_that_any_file_can_hold(sweep, monkeypatch):
    def broken(*_):
        raise ValueError("a\0b \ud83d δ")

    monkeypatch.setattr("drake_formation.sweep.runner.Runner.measure", broken)
    (outcome,) = run_chunk(chunk(sweep, 0)).outcomes
    assert outcome.error == r"ValueError: ab \ud83d δ"


def test_other_code_in_the_same_version_is_other_software(sweep, monkeypatch):
    assert versions()[CODE] == source_hash()[:16]
    with pytest.raises(SweepError, match=f"a worker has {CODE} {versions()[CODE]} where this process has {CODE} other"):
        run_chunk(chunk(sweep, 0, versions=versions() | {CODE: "other"}))


def test_a_worker_with_other_software_refuses(sweep):
    with pytest.raises(SweepError, match=r"a worker has numpy .* where this process has numpy 0\.0"):
        run_chunk(chunk(sweep, 0, versions=versions() | {"numpy": "0.0"}))


def test_chunks_and_reports_can_be_sent(sweep):
    sent = pickle.loads(pickle.dumps(chunk(sweep, 0, 1)))
    report = pickle.loads(pickle.dumps(run_chunk(sent)))
    for found, wanted in zip(report.outcomes, run_chunk(chunk(sweep, 0, 1)).outcomes, strict=True):
        for name, value in found.values.items():
            np.testing.assert_array_equal(value, wanted.values[name])
