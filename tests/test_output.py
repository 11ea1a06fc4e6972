"""A run's folder appears whole or not at all."""

import pytest

from drake_formation.output import RESULT, OutputError, moved_into_place, require_place


def test_a_new_folder_appears_only_when_complete(tmp_path):
    place = tmp_path / "run"
    with moved_into_place(place) as partial:
        (partial / "a").write_text("1")
        assert not place.exists()
    assert (place / "a").read_text() == "1"
    assert list(tmp_path.iterdir()) == [place]


def test_an_earlier_run_is_replaced_as_a_whole(tmp_path):
    place = tmp_path / "run"
    for name in ("old", "new"):
        with moved_into_place(place) as partial:
            (partial / RESULT).touch()
            (partial / name).touch()
    assert sorted(path.name for path in place.iterdir()) == ["new", RESULT]
    assert list(tmp_path.iterdir()) == [place]


def test_a_failure_while_writing_leaves_everything_as_it_was(tmp_path):
    place = tmp_path / "run"
    with moved_into_place(place) as partial:
        (partial / RESULT).write_text("old")
    with pytest.raises(FileNotFoundError), moved_into_place(place) as partial:
        (partial / "missing" / RESULT).write_text("new")
    assert (place / RESULT).read_text() == "old"
    assert list(tmp_path.iterdir()) == [place]


def test_an_empty_folder_may_be_used(tmp_path):
    require_place(tmp_path)


def test_a_file_is_refused(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="is a file"):
        require_place(tmp_path / "file")


def test_a_folder_under_a_file_is_refused(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="cannot be written"):
        require_place(tmp_path / "file" / "run")


def test_what_is_not_a_run_is_never_replaced(tmp_path):
    (tmp_path / "notes.txt").touch()
    with pytest.raises(OutputError, match="something else"):
        require_place(tmp_path)
