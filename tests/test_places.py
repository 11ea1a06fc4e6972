"""A result's place is known to do before anything is computed, and holds the result whole or not at all."""

import re
import threading
from pathlib import Path

import pytest

from drake_formation.places import Kind, OutputError, reserved, reserved_file

RUN = Kind("result", ("picture", "result"))
FAILED = Kind("failure", ("failure",))

REFUSED = {
    "file": "is a file",
    "/dev/null": "is a file",
    "file/run": "file is a file",
    "/dev/null/run": "/dev/null is a file",
    "loop": "link that leads nowhere",
    "loop/run": "cannot be written",
    "dangling": "link that leads nowhere",
    "a" * 300: "name too long",
    "a" * 300 + "/run": "name too long",
    "/".join(["a" * 200] * 30): "name too long",
    "a\0b": "null",
    "a\udcff": "not text",
    "other": "something else",
    "/": "something else",
    "/proc/run": "cannot be written",
}


def write(content, *names):
    def write_to(folder):
        for name in names:
            (folder / name).write_text(content)

    return write_to


def put(folder, content="new", names=("result",)):
    """Write a result; gives where it went and what is to be said of that."""
    with reserved(folder, RUN) as place:
        place.fill(write(content, *names))
        return place.take(), place.notes


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_new_folder_appears_only_when_complete(tmp_path):
    folder = tmp_path / "a" / "run"
    with reserved(folder, RUN) as place:
        place.fill(write("new", "result"))
        assert not folder.exists()
        assert place.take() == folder
    assert names(folder) == ["result"]
    assert names(folder.parent) == ["run"]


def test_an_earlier_result_is_replaced_and_what_else_is_there_stays(tmp_path):
    put(tmp_path / "run", "old", ("result", "picture"))
    (tmp_path / "run" / "notes.txt").touch()
    assert put(tmp_path / "run") == (tmp_path / "run", [])
    assert names(tmp_path / "run") == ["notes.txt", "result"]
    assert (tmp_path / "run" / "result").read_text() == "new"
    assert names(tmp_path) == ["run"]


@pytest.mark.parametrize("failure", [KeyError, KeyboardInterrupt])
def test_a_failure_leaves_everything_as_it_was(tmp_path, failure):
    def fail(folder):
        (folder / "result").write_text("new")
        raise failure

    put(tmp_path / "run", "old")
    for folder in (tmp_path / "run", tmp_path / "a" / "b" / "new"):
        with pytest.raises(failure), reserved(folder, RUN) as place:
            place.fill(fail)
    assert names(tmp_path) == ["run"]
    assert names(tmp_path / "run") == ["result"]
    assert (tmp_path / "run" / "result").read_text() == "old"


@pytest.mark.parametrize("name", [".", "../here", "empty", "link"])
def test_an_empty_folder_is_filled_by_whatever_name(tmp_path, monkeypatch, name):
    for folder in ("here", "there", "with/empty"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "with" / "link").symlink_to(tmp_path / "there")
    monkeypatch.chdir(tmp_path / ("here" if "." in name else "with"))
    assert put(Path(name)) == (Path(name), [])
    assert names(Path(name)) == ["result"]


def test_however_deep_a_new_folder_is_nothing_remains_of_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with reserved(Path("a/" * 1500), RUN):
        assert names(tmp_path) == ["a"]
    assert names(tmp_path) == []


@pytest.mark.parametrize("name", REFUSED)
def test_a_place_that_will_not_do_is_refused_before_the_work(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    Path("file").touch()
    Path("loop").symlink_to("loop")
    Path("dangling").symlink_to("nowhere")
    Path("other").mkdir()
    Path("other/thesis.tex").touch()
    with pytest.raises(OutputError, match=re.escape(name)) as refusal, reserved(Path(name), RUN):
        pytest.fail("the work has begun")
    assert REFUSED[name] in str(refusal.value)
    assert names(tmp_path) == ["dangling", "file", "loop", "other"]


def test_of_two_to_one_new_folder_each_keeps_its_result(tmp_path):
    with reserved(tmp_path / "run", RUN) as first, reserved(tmp_path / "run", RUN) as second:
        first.fill(write("first", "result"))
        second.fill(write("second", "result"))
        assert second.take() == tmp_path / "run"
        assert first.take() == tmp_path / "run-2"
    assert first.notes == [f"{tmp_path / 'run'} has been taken meanwhile."]
    assert [(tmp_path / name / "result").read_text() for name in ("run", "run-2")] == ["second", "first"]
    assert names(tmp_path) == ["run", "run-2"]


def test_of_two_to_one_earlier_result_each_keeps_its_own(tmp_path):
    put(tmp_path / "run", "old")
    with reserved(tmp_path / "run", RUN) as first, reserved(tmp_path / "run", RUN) as second:
        first.fill(write("first", "result"))
        second.fill(write("second", "result"))
        assert second.take() == tmp_path / "run"
        assert first.take() == tmp_path / "run-2"
    assert [(tmp_path / name / "result").read_text() for name in ("run", "run-2")] == ["second", "first"]


def test_of_many_at_once_each_keeps_its_result(tmp_path):
    def one(number):
        where[number] = put(tmp_path / "run", str(number))[0]

    where = {}
    (tmp_path / "run").mkdir()
    threads = [threading.Thread(target=one, args=(number,)) for number in range(12)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    # One that begins when another has ended may replace its result: it has asked for that.
    kept = {path.name: (path / "result").read_text() for path in tmp_path.iterdir()}
    assert set(kept.values()) <= {str(number) for number in where}
    assert {path.name for path in where.values()} == set(kept)
    assert all((path / "result").is_file() for path in where.values())


def test_a_file_in_the_place_meanwhile_is_no_loss(tmp_path):
    with reserved(tmp_path / "run", RUN) as place:
        place.fill(write("new", "result"))
        (tmp_path / "run").write_text("precious")
        assert place.take() == tmp_path / "run-2"
    assert (tmp_path / "run").read_text() == "precious"


def test_a_folder_removed_meanwhile_is_no_loss(tmp_path):
    (tmp_path / "a" / "run").mkdir(parents=True)
    with reserved(tmp_path / "a" / "run", RUN) as place:
        for folder in (place._staging, tmp_path / "a" / "run", tmp_path / "a"):
            folder.rmdir()
        place.fill(write("new", "result"))
        assert (place.take() / "result").read_text() == "new"


def test_what_cannot_be_written_goes_to_the_temporary_folder(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "tmp"))
    (tmp_path / "tmp").mkdir()
    with reserved(tmp_path / "run", RUN) as place:

        def write_where_there_is_room(folder):
            if folder.parent == tmp_path:
                raise OSError(28, "No space left on device")
            (folder / "result").write_text("new")

        place.fill(write_where_there_is_room)
        kept = place.take()
    assert kept.parent == tmp_path / "tmp"
    assert (kept / "result").read_text() == "new"
    assert "No space left" in place.notes[0]
    assert names(tmp_path) == ["tmp"]


def test_beside_the_place_the_first_name_that_holds_nothing_else_is_taken(tmp_path):
    (tmp_path / "run.failed").mkdir()
    (tmp_path / "run.failed" / "thesis.tex").touch()
    for content in ("first", "second"):
        with reserved(tmp_path / "run", RUN) as place:
            place.fill(write(content, "failure"))
            assert place.take_beside(".failed", FAILED) == tmp_path / "run.failed-2"
        assert place.notes == [f"{tmp_path / 'run.failed'} holds something else."]
    assert (tmp_path / "run.failed-2" / "failure").read_text() == "second"
    assert names(tmp_path) == ["run.failed", "run.failed-2"]
    assert names(tmp_path / "run.failed") == ["thesis.tex"]


def test_beside_the_current_folder_is_under_its_name(tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    with reserved(Path(), RUN) as place:
        place.fill(write("x", "failure"))
        assert place.take_beside(".failed", FAILED) == tmp_path / "here.failed"


def test_beside_a_name_as_long_as_can_be_it_is_cut(tmp_path):
    with reserved(tmp_path / ("ä" * 127), RUN) as place:
        place.fill(write("x", "failure"))
        assert place.take_beside(".failed", FAILED).name == "ä" * 124 + ".failed"


def test_a_file_is_written_whole_or_not_at_all(tmp_path):
    (tmp_path / "a.svg").write_text("old")
    with pytest.raises(IsADirectoryError), reserved_file(tmp_path / "a.svg"):
        tmp_path.write_text("half")
    assert (tmp_path / "a.svg").read_text() == "old"
    with reserved_file(tmp_path / "a.svg") as partial:
        assert partial.suffix == ".svg"
        partial.write_text("new")
    assert (tmp_path / "a.svg").read_text() == "new"
    assert names(tmp_path) == ["a.svg"]


@pytest.mark.parametrize(
    "name", ["missing/a.svg", "file/a.svg", "a" * 300 + ".svg", "folder.svg", "a\0.svg", "loop.svg"]
)
def test_a_file_that_cannot_be_written_is_refused_before_the_work(tmp_path, name):
    (tmp_path / "file").touch()
    (tmp_path / "folder.svg").mkdir()
    (tmp_path / "loop.svg").symlink_to("loop.svg")
    with pytest.raises(OutputError), reserved_file(tmp_path / name):
        pytest.fail("the work has begun")
    assert names(tmp_path) == ["file", "folder.svg", "loop.svg"]
