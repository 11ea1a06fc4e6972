"""Two commands at once into one folder: one of them is told so, or both results are whole."""

import json
import re
from pathlib import Path

import pytest
from faults.conftest import RUN, ended, files, started


def test_a_second_sweep_is_told_to_wait(cli, quick, tmp_path):
    from drake_formation.sweep import load_sweep
    from drake_formation.sweep.store import Store

    with Store(tmp_path / "o", {"sweep": load_sweep(quick).fingerprint()}):
        status, _, err = cli("sweep", quick, "--out", tmp_path / "o", "--executor", "serial")
    assert status == 2
    assert "another process is sweeping into this folder; wait for it" in err


@pytest.mark.slow
def test_two_runs_are_both_whole_and_each_says_where(tmp_path):
    processes = [started(*RUN, f"--set=springs.stiffness={k}", "--out", "o", cwd=tmp_path) for k in (1.0, 2.0)]
    places = []
    for process in processes:
        result = ended(process)
        assert result.status == 0
        places.append(tmp_path / re.search(r"Results in (\S+), pictures", result.out)[1])
    stiffness = []
    for place in places:
        assert {"metrics.json", "result.nc", "scenario.yaml"} <= set(files(place))
        json.loads((place / "metrics.json").read_text())
        stiffness.append(re.search(r"stiffness: ([\d.]+)", (place / "scenario.yaml").read_text())[1])
    if places[0] != places[1]:
        assert [float(value) for value in stiffness] == [1.0, 2.0]


@pytest.mark.slow
@pytest.mark.parametrize("parts", [("table1",)])
def test_two_studies_both_have_their_report(tmp_path, parts):
    only = [word for part in parts for word in ("--only", part)]
    processes = [started("reproduce", *only, "--out", "o", cwd=tmp_path) for _ in range(2)]
    for process in processes:
        result = ended(process)
        assert result.status == 0
        report = tmp_path / re.search(r"Report in (\S+),", result.out)[1]
        assert "<table>" in Path(report).read_text(encoding="utf-8")
