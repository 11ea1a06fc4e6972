"""``run --animate`` writes a film beside the run, and refuses what it cannot write before anything runs."""

from pathlib import Path

import pytest

from drake_formation.viz import animation

SHORT = ["--set", "aggregation.duration=1", "--set", "transport.duration=2", "--out", "run"]


def test_a_run_has_a_film(cli, monkeypatch):
    monkeypatch.setattr(animation, "RATE", 1)
    status, out, _ = cli("run", "line", *SHORT, "--animate", "line.gif")
    assert status == 0
    assert "Film in line.gif." in out
    assert Path("line.gif").read_bytes().startswith(b"GIF89a")
    assert Path("run/metrics.json").exists()


@pytest.mark.parametrize("film", ["line.avi", "nowhere/line.gif", "line"])
def test_a_film_that_cannot_be_written_is_refused_first(cli, film):
    status, _, err = cli("run", "line", *SHORT, "--animate", film)
    assert status == 2
    assert Path(film).name in err
    assert not Path("run").exists()
