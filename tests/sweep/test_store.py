"""What a store keeps it keeps bit by bit, through kills, and for one sweep at a time."""

import sqlite3
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from drake_formation.sweep.errors import SweepError, SweepStoppedError
from drake_formation.sweep.store import DATABASE, LOCK, Store
from drake_formation.sweep.work import CODE, Outcome

IDENTITY = {"sweep": "abc", "engine": "compiled", "drake": "1.51.1"}

numbers = arrays.arrays(float, arrays.array_shapes(min_dims=0, max_dims=3, max_side=7), elements=st.floats(width=64))
values = st.dictionaries(st.sampled_from(["peak_force_n", "tracking_error_m", "position"]), numbers)


def same(first, second):
    """Whether two outcomes are the same to the last bit."""
    assert (first.index, first.error, list(first.values)) == (second.index, second.error, list(second.values))
    for name, value in first.values.items():
        assert value.shape == second.values[name].shape
        assert value.astype("<f8").tobytes() == second.values[name].astype("<f8").tobytes()


@given(st.lists(values, min_size=1, max_size=4))
def test_numbers_come_back_to_the_last_bit(tmp_path_factory, runs):
    outcomes = [Outcome(3 * k, None, run) for k, run in enumerate(runs)]
    folder = tmp_path_factory.mktemp("store")
    with Store(folder, IDENTITY) as store:
        store.add(outcomes)
    with Store(folder, IDENTITY) as store:
        for wanted, found in zip(outcomes, store.outcomes(0, 100), strict=True):
            same(wanted, found)


def test_outcomes_come_in_order_from_any_range(tmp_path):
    with Store(tmp_path / "new" / "folder", IDENTITY) as store:
        store.add([Outcome(k, None, {"x": np.array(float(k))}) for k in (4, 1, 3)])
        store.add([Outcome(0, "it broke")])
        assert [outcome.index for outcome in store.outcomes(1, 4)] == [1, 3]
        finished, failed = store.kept(6)
        assert finished.tolist() == [True, True, False, True, True, False]
        assert failed.tolist() == [True, False, False, False, False, False]
        assert list(store.failures()) == [(0, "it broke")]


def test_a_run_made_again_replaces_the_first(tmp_path):
    with Store(tmp_path, IDENTITY) as store:
        store.add([Outcome(0, "it broke")])
        store.add([Outcome(0, None, {"x": np.array(1.0)})])
        assert not list(store.failures())
        assert next(store.outcomes(0, 1)).values["x"] == 1.0


def test_shapes_are_the_largest_of_any_run(tmp_path):
    with Store(tmp_path, IDENTITY) as store:
        store.add([Outcome(0, None, {"a": np.zeros((2, 5)), "b": np.zeros(())})])
        store.add([Outcome(1, None, {"a": np.zeros((3, 4))})])
        assert store.shapes() == {"a": (3, 5), "b": ()}
        store.add([Outcome(1, "it broke")])
        assert store.shapes() == {"a": (2, 5), "b": ()}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"sweep": "xyz"}, "another sweep"),
        ({"engine": "blocks"}, r"engine compiled, now blocks"),
        ({"drake": "1.58.0"}, r"drake 1\.51\.1, now 1\.58\.0"),
    ],
)
def test_runs_of_another_identity_are_refused(tmp_path, change, message):
    with Store(tmp_path, IDENTITY) as store:
        store.add([Outcome(0, None, {"x": np.array(1.0)})])
    with pytest.raises(SweepError, match=message), Store(tmp_path, IDENTITY | change):
        pass
    with Store(tmp_path, IDENTITY) as store:
        assert store.kept(1)[0].all()


def test_a_second_process_is_refused_and_let_in_when_the_first_is_gone(tmp_path):
    code = f"""
import sys
from pathlib import Path
from drake_formation.sweep.store import Store
with Store(Path({str(tmp_path)!r}), {IDENTITY!r}):
    print("in", flush=True)
    sys.stdin.read()
"""
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout.readline() == b"in\n"
        with pytest.raises(SweepError, match="another process"), Store(tmp_path, IDENTITY):
            pass
        other.kill()
        other.wait()
        with Store(tmp_path, IDENTITY) as store:
            assert not store.kept(3)[0].any()


@pytest.mark.parametrize("moment", ["before", "within", "after"])
def test_a_kill_loses_what_was_not_committed_and_nothing_else(tmp_path, moment):
    code = f"""
import os, signal
from pathlib import Path
import numpy as np
from drake_formation.sweep.store import Store
from drake_formation.sweep.work import Outcome

class Deadly(Store):
    def _row(self, outcome):
        if outcome.index == 13 and {moment!r} == "within":
            os.kill(os.getpid(), signal.SIGKILL)
        return super()._row(outcome)

with Deadly(Path({str(tmp_path)!r}), {IDENTITY!r}) as store:
    store.add([Outcome(k, None, {{"x": np.arange(300.0) + k}}) for k in range(10)])
    if {moment!r} == "before":
        os.kill(os.getpid(), signal.SIGKILL)
    store.add([Outcome(k, None, {{"x": np.arange(300.0) + k}}) for k in range(10, 20)])
    os.kill(os.getpid(), signal.SIGKILL)
"""
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == -9
    with Store(tmp_path, IDENTITY) as store:
        found = list(store.outcomes(0, 100))
    assert len(found) == (20 if moment == "after" else 10)
    for k, outcome in enumerate(found):
        same(outcome, Outcome(k, None, {"x": np.arange(300.0) + k}))


def test_a_folder_with_something_else_is_refused_and_left_alone(tmp_path):
    (tmp_path / "thesis.tex").write_text("…")
    with pytest.raises(SweepError, match="something else"), Store(tmp_path, IDENTITY):
        pass
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_a_file_is_no_folder(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(SweepError, match="is a file"), Store(tmp_path / "file", IDENTITY):
        pass
    with pytest.raises(SweepError, match="cannot be written"), Store(tmp_path / "file" / "below", IDENTITY):
        pass


def test_a_damaged_database_is_refused_and_left_alone(tmp_path):
    (tmp_path / LOCK).write_text("")
    (tmp_path / DATABASE).write_bytes(b"no database at all" * 100)
    with pytest.raises(SweepError, match="is damaged"), Store(tmp_path, IDENTITY):
        pass
    assert (tmp_path / DATABASE).read_bytes().startswith(b"no database")


def filled(folder):
    """A store of some hundred pages."""
    with Store(folder, IDENTITY) as store:
        store.add([Outcome(k, None, {"x": np.random.default_rng(k).random(1000)}) for k in range(60)])
    return folder / DATABASE


def test_a_database_that_was_cut_is_refused_and_left_alone(tmp_path):
    database = filled(tmp_path)
    whole = database.read_bytes()
    for share in (0.9, 0.5, 0.1):
        database.write_bytes(whole[: int(share * len(whole))])
        with (
            pytest.raises(SweepError, match=r"is damaged .*move it away to run the sweep anew"),
            Store(tmp_path, IDENTITY),
        ):
            pass
        assert database.stat().st_size == int(share * len(whole))


def test_a_byte_that_changed_never_becomes_another_number(tmp_path):
    database = filled(tmp_path)
    whole = database.read_bytes()
    wanted = [np.random.default_rng(k).random(1000) for k in range(60)]
    noticed = 0
    for place in np.random.default_rng(1).integers(100, len(whole), 60):
        database.write_bytes(whole[:place] + bytes([whole[place] ^ 0x10]) + whole[place + 1 :])
        try:
            with Store(tmp_path, IDENTITY) as store:
                found = list(store.outcomes(0, 60))
        except SweepError:
            noticed += 1
        else:
            for outcome in found:
                np.testing.assert_array_equal(outcome.values["x"], wanted[outcome.index])
    assert noticed > 40


def test_a_database_that_someone_holds_is_said_so(tmp_path, monkeypatch):
    database = filled(tmp_path)
    connect = sqlite3.connect
    monkeypatch.setattr(sqlite3, "connect", lambda *places, **settings: connect(*places, **settings, timeout=0.1))
    with connect(database) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(SweepError, match="cannot be used: database is locked"), Store(tmp_path, IDENTITY):
            pass
    with Store(tmp_path, IDENTITY) as store:
        assert store.kept(60)[0].all()


def test_runs_of_other_code_are_refused_with_what_to_do(tmp_path):
    with Store(tmp_path, IDENTITY | {CODE: "abc"}) as store:
        store.add([Outcome(0, None, {"x": np.array(1.0)})])
    message = f"{CODE} abc, now xyz.*give another folder, or go back to the code that made them"
    with pytest.raises(SweepError, match=message), Store(tmp_path, IDENTITY | {CODE: "xyz"}):
        pass


def test_runs_of_a_version_that_noted_no_code_are_refused_in_words(tmp_path):
    with Store(tmp_path, IDENTITY) as store:
        store.add([Outcome(0, None, {"x": np.array(1.0)})])
    message = "did not note by which code"
    with pytest.raises(SweepError, match=message), Store(tmp_path, IDENTITY | {CODE: "xyz"}):
        pass


def test_a_folder_without_runs_is_anybodys(tmp_path):
    with Store(tmp_path, IDENTITY):
        pass
    with Store(tmp_path, IDENTITY | {"engine": "blocks"}) as store:
        store.add([Outcome(0, None, {"x": np.array(1.0)})])
    with pytest.raises(SweepError, match="engine blocks, now compiled"), Store(tmp_path, IDENTITY):
        pass


def test_what_cannot_be_written_stops_the_sweep_and_keeps_what_was(tmp_path):
    with Store(tmp_path, IDENTITY) as store:
        store.add([Outcome(0, None, {"x": np.zeros(3)})])
        store._database.execute("PRAGMA max_page_count = 12")
        with pytest.raises(SweepStoppedError, match="cannot be written"):
            store.add([Outcome(k, None, {"x": np.random.default_rng(k).random(5000)}) for k in range(1, 9)])
        assert store.kept(9)[0].sum() == 1
    with sqlite3.connect(tmp_path / DATABASE) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
