"""Compiled code on disk."""

import os
import shutil
import subprocess
import sys

import pytest

from drake_formation import machine_code

SOURCE = """from numba import njit


@njit("float64(float64)", cache=True)
def twice(x):
    return 2.0 * x
"""
LOAD = f"from drake_formation import machine_code; print(machine_code.load({SOURCE!r}).twice(2.0))"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv(machine_code.FOLDER, str(tmp_path))
    return tmp_path


def loaded_elsewhere():
    result = subprocess.run([sys.executable, "-c", LOAD], capture_output=True, text=True, check=True)
    return float(result.stdout)


def contents(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_an_entry_is_made_once(folder):
    assert loaded_elsewhere() == 4.0
    before = contents(folder)
    assert loaded_elsewhere() == 4.0
    assert len(list(folder.iterdir())) == 1
    assert contents(folder) == before


def test_a_damaged_entry_is_made_anew(folder):
    loaded_elsewhere()
    for path in contents(folder):
        if path.suffix in (".nbi", ".nbc"):
            path.write_bytes(b"damaged")
    assert loaded_elsewhere() == 4.0
    assert b"damaged" not in contents(folder).values()


def test_a_folder_that_cannot_be_made_is_done_without(folder, monkeypatch):
    (folder / "file").write_text("")
    monkeypatch.setenv(machine_code.FOLDER, str(folder / "file"))
    assert loaded_elsewhere() == 4.0


def test_a_disk_without_room_for_the_machine_code_is_done_without(folder):
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)); "
    result = subprocess.run([sys.executable, "-c", limit + LOAD], capture_output=True, text=True, check=True)
    assert result.stdout == "4.0\n"
    assert not list(folder.iterdir())


def test_a_folder_that_is_made_is_its_users_alone(tmp_path, monkeypatch):
    monkeypatch.setenv(machine_code.FOLDER, str(tmp_path / "new" / "cache"))
    assert loaded_elsewhere() == 4.0
    assert (tmp_path / "new" / "cache").stat().st_mode & 0o777 == 0o700


@pytest.mark.parametrize("mode", [0o777, 0o775, 0o757])
def test_a_folder_that_others_may_write_to_is_not_read(folder, mode):
    loaded_elsewhere()
    before = contents(folder)
    folder.chmod(mode)
    result = subprocess.run([sys.executable, "-c", LOAD], capture_output=True, text=True, check=True)
    assert result.stdout == "4.0\n"
    assert "may be written to by others" in result.stderr
    assert contents(folder) == before


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a folder away")
def test_another_users_folder_or_entry_is_not_read(folder):
    loaded_elsewhere()
    (entry,) = folder.iterdir()
    os.chown(entry, 12345, 12345)
    assert loaded_elsewhere() == 4.0
    assert entry.stat().st_uid == 0
    os.chown(folder, 12345, 12345)
    result = subprocess.run([sys.executable, "-c", LOAD], capture_output=True, text=True, check=True)
    assert result.stdout == "4.0\n"
    assert "another user's" in result.stderr


def emptied(entry):
    for path in entry.rglob("*"):
        if path.is_file():
            path.write_bytes(b"")


def cut(entry):
    for path in entry.rglob("*"):
        if path.is_file():
            path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def replaced_by_a_file(entry):
    shutil.rmtree(entry)
    entry.write_text("no folder")


def replaced_by_a_link(entry):
    entry.rename(entry.with_name("elsewhere"))
    entry.symlink_to("elsewhere")


def without_rights(entry):
    for path in entry.iterdir():
        path.chmod(0)
    entry.chmod(0)


@pytest.mark.parametrize("damage", [emptied, cut, replaced_by_a_file, replaced_by_a_link, without_rights])
def test_whatever_stands_in_an_entrys_place_the_result_is_right(folder, damage):
    loaded_elsewhere()
    (entry,) = folder.iterdir()
    damage(entry)
    assert loaded_elsewhere() == 4.0
    assert loaded_elsewhere() == 4.0


def test_any_number_of_processes_may_be_the_first(folder):
    running = [subprocess.Popen([sys.executable, "-c", LOAD], stdout=subprocess.PIPE, text=True) for _ in range(4)]
    assert [process.communicate()[0] for process in running] == ["4.0\n"] * 4
    assert len(list(folder.iterdir())) == 1
