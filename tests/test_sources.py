"""The hash of the package's sources notices every change of code, and nothing else."""

import subprocess
import sys

import pytest

from drake_formation.sources import hash_of, source_hash


@pytest.fixture
def package(tmp_path):
    folder = tmp_path / "package"
    (folder / "inner").mkdir(parents=True)
    (folder / "a.py").write_text("one = 1\n")
    (folder / "inner" / "b.py").write_text("two = 2\n")
    return folder


def test_it_is_the_same_in_every_process():
    command = "from drake_formation.sources import source_hash; print(source_hash())"
    found = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == source_hash()
    assert len(source_hash()) == 64


def test_what_is_no_source_does_not_count(package):
    before = hash_of(package)
    (package / "__pycache__").mkdir()
    (package / "__pycache__" / "a.pyc").write_bytes(b"code")
    (package / "a.py").touch()
    assert hash_of(package) == before


def test_every_change_of_a_source_counts(package):
    found = [hash_of(package)]
    (package / "a.py").write_text("one = 2\n")
    found.append(hash_of(package))
    (package / "a.py").rename(package / "c.py")
    found.append(hash_of(package))
    (package / "d.py").write_text("")
    found.append(hash_of(package))
    (package / "d.py").unlink()
    (package / "c.py").unlink()
    (package / "inner" / "b.py").write_text("one = 2\ntwo = 2\n")
    found.append(hash_of(package))
    assert len(set(found)) == len(found)
