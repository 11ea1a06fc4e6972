"""Compiled code on disk."""

import subprocess
import sys

import pytest

from drake_formation.lowering import cache

SOURCE = """from numba import njit


@njit("float64(float64)", cache=True)
def twice(x):
    return 2.0 * x
"""
LOAD = f"from drake_formation.lowering import cache; print(cache.load({SOURCE!r}).twice(2.0))"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv(cache.FOLDER, str(tmp_path))
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
    monkeypatch.setenv(cache.FOLDER, str(folder / "file"))
    assert loaded_elsewhere() == 4.0
