"""A scenario to start from, and its picture before it runs."""

from pathlib import Path

import pytest

from drake_formation.scenario import load_scenario


def test_a_new_scenario_validates_is_drawn_and_runs(cli):
    assert cli("new", "mine") == (
        0,
        "A scenario to start from is in mine.yaml.\n"
        "Next: drake-formation show mine.yaml, then drake-formation run mine.yaml.\n",
        "",
    )
    assert cli("validate", "mine.yaml")[0] == 0
    assert cli("show", "mine.yaml") == (0, "The scenario is drawn in mine.png.\n", "")
    assert Path("mine.png").read_bytes().startswith(b"\x89PNG")
    status, out, _ = cli("run", "mine.yaml")
    assert status == 0
    assert "Results in out/mine" in out
    assert "warning" not in out
    assert Path("out/mine/scenario.yaml").read_text().startswith("# yaml-language-server: $schema=file://")


def test_nothing_is_overwritten(cli):
    Path("mine.yaml").write_text("precious")
    status, _, err = cli("new", "mine")
    assert status == 2
    assert "mine.yaml: is there already" in err
    assert Path("mine.yaml").read_text() == "precious"


def test_a_file_may_be_named_and_a_shipped_scenario_be_the_beginning(cli):
    assert cli("new", "mine.yml", "--from", "octagon")[0] == 0
    assert load_scenario("mine.yml") == load_scenario("octagon", overrides={"name": "mine"})


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["mine", "--from", "octogon"], "did you mean 'octagon'"),
        (["missing/mine"], "missing/mine.yaml: cannot be written"),
        (["my scenario"], "name"),
        (["."], "name"),
        (["/"], "name"),
        (["a" * 300], "File name too long"),
        ([""], "an empty name"),
    ],
)
def test_what_cannot_be_is_refused(cli, words, said):
    status, _, err = cli("new", *words)
    assert status == 2
    assert said in err
    assert list(Path().iterdir()) == []


def test_a_picture_of_another_format_is_refused(cli):
    status, _, err = cli("show", "line", "-o", "line.gif")
    assert status == 2
    assert "must end in .png, .svg, .pdf" in err
