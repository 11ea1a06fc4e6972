"""Damaged files: a sweep's database, a study's results, the compiler's cache."""

import hashlib
import itertools
import json
import os
import shutil
import sqlite3

import pytest
from faults.conftest import RUN, ended, files, started, sweep_file

DAMAGES = {
    "emptied": lambda whole: b"",
    "cut": lambda whole: whole[: len(whole) // 2],
    "garbage": lambda whole: b"no such thing " * (len(whole) // 14 + 1),
}


@pytest.mark.parametrize("damage", ["cut", "garbage"])
def test_a_damaged_database_is_said_so_and_left_alone(cli, tmp_path, damage):
    command = ("sweep", sweep_file(tmp_path, 30), "--out", tmp_path / "o", "--executor", "serial")
    assert cli(*command)[0] == 0
    database = tmp_path / "o" / "runs.sqlite"
    database.write_bytes(damaged := DAMAGES[damage](database.read_bytes()))
    status, _, err = cli(*command)
    assert status == 2
    assert "runs.sqlite: is damaged" in err
    assert "move it away to run the sweep anew" in err
    assert database.read_bytes() == damaged
    database.unlink()
    assert cli(*command)[0] == 0


def test_a_database_that_another_program_holds_is_said_so(cli, tmp_path):
    command = ("sweep", sweep_file(tmp_path, 4), "--out", tmp_path / "o", "--executor", "serial")
    assert cli(*command)[0] == 0
    with sqlite3.connect(tmp_path / "o" / "runs.sqlite") as other:
        other.execute("BEGIN EXCLUSIVE")
        status, _, err = cli(*command)
    assert status == 2
    assert "runs.sqlite: cannot be used: database is locked" in err


@pytest.fixture(scope="module")
def warm(tmp_path_factory):
    """A cache with what the run needs, and the run's metrics."""
    folder = tmp_path_factory.mktemp("warm")
    return folder / "cache", metrics_with(folder / "cache", folder)


def metrics_with(cache, folder):
    """Metrics of the run with a cache folder."""
    environment = os.environ | {"DRAKE_FORMATION_CACHE_DIR": str(cache)}
    result = ended(started(*RUN, "--out", folder / "o", cwd=folder, env=environment))
    assert result.status == 0
    return (folder / "o" / "metrics.json").read_text()


@pytest.mark.slow
def test_damaged_machine_code_is_compiled_again(warm, tmp_path):
    """Each file of an entry in another way."""
    shutil.copytree(warm[0], tmp_path / "cache")
    for name, damage in zip(files(tmp_path / "cache"), itertools.cycle(DAMAGES.values()), strict=False):
        path = tmp_path / "cache" / name
        path.write_bytes(damage(path.read_bytes()))
    assert metrics_with(tmp_path / "cache", tmp_path) == warm[1]


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can give files away")
def test_another_users_cache_is_not_run(warm, tmp_path):
    """Not even one whose checksums are right."""
    shutil.copytree(warm[0], tmp_path / "cache")
    for listed in (tmp_path / "cache").rglob("checksums.json"):
        module = listed.with_name("compiled.py")
        module.write_text("import os; os._exit(99)")
        sums = json.loads(listed.read_text()) | {module.name: hashlib.sha256(module.read_bytes()).hexdigest()}
        listed.write_text(json.dumps(sums))
    for path in [tmp_path / "cache", *(tmp_path / "cache").rglob("*")]:
        os.chown(path, 65534, 65534)
    assert metrics_with(tmp_path / "cache", tmp_path) == warm[1]
