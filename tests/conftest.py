import os
import sys

# Many small matrices: threads of the linear algebra would wait for one another most of the time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from examples import load_profile

from drake_formation.cli import main

load_profile()


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
