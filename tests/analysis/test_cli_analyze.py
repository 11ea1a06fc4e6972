"""``drake-formation analyze``: what it prints, what it writes, and what it refuses."""

import json
from pathlib import Path

import pytest

from drake_formation import load_scenario


def test_analyze_prints_a_certificate_and_writes_nothing(cli):
    status, out, _ = cli("analyze", "line", "--set", "consensus.delta=1e4")
    assert status == 0
    assert "stable: yes" in out
    assert not list(Path().iterdir())


def test_analyze_writes_certificate_scenario_and_figures(cli):
    status, out, _ = cli("analyze", "line", "--set", "consensus.delta=1e4", "--out", "results/line")
    folder = Path("results/line")
    assert status == 0
    assert "results/line" in out
    told = json.loads((folder / "certificate.json").read_text())
    assert set(told) >= {"modes", "delay_margin_s", "loss_margin", "not_covered", "versions", "units", "scenario"}
    assert load_scenario(folder / "scenario.yaml").consensus.delta == 1e4
    pictures = sorted((folder / "figures").glob("*.png"))
    assert [picture.stem for picture in pictures] == [
        "delay_margin",
        "error_against_channels",
        "error_against_effort",
        "mode_map",
        "root_locus",
    ]
    assert all(picture.read_bytes().startswith(b"\x89PNG") for picture in pictures)
    assert [path.name for path in Path("results").iterdir()] == ["line"]


def test_analyze_of_the_resolved_scenario_repeats_the_certificate(cli):
    cli("analyze", "line", "--set", "springs.stiffness=30", "--out", "first")
    assert cli("analyze", "first/scenario.yaml", "--out", "second")[0] == 0
    first, second = (json.loads(Path(name, "certificate.json").read_text()) for name in ("first", "second"))
    assert first == second


def test_an_unstable_loop_is_a_certificate_too(cli):
    weights = ["--set", "tracking.Q=[1,1,1e4,1]", "--set", "tracking.R=[[1,0.9],[0.9,1]]"]
    status, out, _ = cli(
        "analyze", "line", *weights, "--set", "formation.heading=150", "--set", "springs.stiffness=3e4", "--out", "o"
    )
    assert status == 0
    assert "stable: no" in out
    told = json.loads(Path("o/certificate.json").read_text())
    assert told["stable"] is False
    assert told["unanswered"]
    assert "No figure delay_margin: " in out
    assert Path("o/figures/mode_map.png").exists()


@pytest.mark.parametrize(
    "option", [("--period", 0), ("--damping-ratio", 2), ("--decay-rate", -1), ("--force-limit", 0)]
)
def test_what_cannot_be_asked_is_refused(cli, option):
    status, out, err = cli("analyze", "line", *option, "--out", "o")
    assert status == 2
    assert "allowed" in err
    assert not out
    assert not Path("o").exists()


def test_a_wrong_scenario_is_refused(cli):
    status, _, err = cli("analyze", "lime")
    assert status == 2
    assert "'line'" in err


def test_a_run_is_not_lost_to_a_certificate(cli):
    cli("run", "line", "--set", "aggregation.duration=1", "--set", "transport.duration=1", "--out", "o")
    status, _, err = cli("analyze", "line", "--out", "o")
    assert status == 2
    assert "would be lost" in err
    assert Path("o/result.nc").exists()


def test_an_earlier_certificate_is_replaced(cli):
    for delta in (1e3, 1e4):
        assert cli("analyze", "line", "--set", f"consensus.delta={delta}", "--out", "o")[0] == 0
    assert json.loads(Path("o/certificate.json").read_text())["scenario"]["consensus"]["delta"] == 1e4
