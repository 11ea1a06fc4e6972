import os
import sys

# Many small matrices: threads of the linear algebra would wait for one another most of the time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings

from drake_formation.cli import main

# Building a diagram takes as long as it takes, on a busy machine longer than Hypothesis' 0.2 s.
settings.register_profile("drake-formation", deadline=None)
settings.load_profile("drake-formation")


@pytest.fixture
def cli(monkeypatch, capsys, tmp_path):
    """Run the command in an empty folder; gives the exit status, standard output and standard error."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["drake-formation", *map(str, arguments)])
        try:
            main()
            status = 0
        except SystemExit as stop:
            status = stop.code or 0
        captured = capsys.readouterr()
        assert "Traceback" not in captured.out + captured.err
        return status, captured.out, captured.err

    return run
