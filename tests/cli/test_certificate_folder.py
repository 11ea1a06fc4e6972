"""The folder of a certificate: complete, or not there; and never in the place of something else."""

import json

import pytest

from drake_formation import load_scenario
from drake_formation.analysis import Questions, certify
from drake_formation.cli import certificate_folder
from drake_formation.cli.certificate_folder import CERTIFICATE, CERTIFICATE_FILE, FIGURES, write_certificate
from drake_formation.cli.run_folder import RUN
from drake_formation.places import OutputError, reserved


def write(folder, certificate):
    """Write a certificate; gives the pictures that are missing, and why."""
    with reserved(folder, CERTIFICATE) as place:
        return write_certificate(place, certificate).failed


@pytest.fixture(scope="module")
def certificate():
    return certify(load_scenario("line", overrides={"consensus.delta": 1e4}))


def test_everything_is_written(certificate, tmp_path):
    assert write(tmp_path / "line", certificate) == {}
    pictures = {path.stem for path in (tmp_path / "line" / "figures").iterdir()}
    assert pictures == set(FIGURES)
    assert json.loads((tmp_path / "line" / "certificate.json").read_text()) == json.loads(certificate.to_json())


def test_what_fails_on_the_way_leaves_the_earlier_certificate(certificate, tmp_path, monkeypatch):
    write(tmp_path / "line", certificate)

    def fails(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(certificate_folder, "FIGURES", {"mode_map": fails})
    with pytest.raises(KeyboardInterrupt):
        write(tmp_path / "line", certify(load_scenario("quadrilateral")))
    assert json.loads((tmp_path / "line" / "certificate.json").read_text())["name"] == "line"
    assert [path.name for path in tmp_path.iterdir()] == ["line"]


@pytest.mark.parametrize("file", ["result.nc", "thesis.tex"])
def test_a_place_that_holds_something_else_is_refused(tmp_path, file):
    (tmp_path / file).touch()
    with pytest.raises(OutputError, match="would be lost"), reserved(tmp_path, CERTIFICATE):
        pytest.fail("it is not")


def test_a_run_does_not_take_the_place_of_a_certificate(tmp_path):
    (tmp_path / CERTIFICATE_FILE).touch()
    with pytest.raises(OutputError, match="would be lost"), reserved(tmp_path, RUN):
        pytest.fail("it is not")


def test_one_robot_has_no_margins_to_draw(tmp_path):
    overrides = {"formation": {"shape": "line", "robots": 1, "side": 1.0}, "robots.start": {"centre": [0, 0]}}
    left_out = write(tmp_path / "one", certify(load_scenario("line", overrides=overrides)))
    assert {"delay_margin", "error_against_effort", "error_against_channels"} == set(left_out)
    assert all(left_out.values())


def test_robots_that_do_not_talk_have_no_delay_to_draw(tmp_path):
    silent = load_scenario("line", overrides={"consensus.graph": [], "springs.graph": []})
    left_out = write(tmp_path / "silent", certify(silent))
    assert "no robot talks" in left_out["delay_margin"]


def test_channels_of_many_robots_are_drawn_where_asked(certificate, tmp_path, monkeypatch):
    monkeypatch.setattr(certificate_folder, "FEW_ROBOTS", 1)
    assert set(write(tmp_path / "unasked", certificate)) == {"error_against_channels"}
    asked = certify(certificate.scenario, questions=Questions(consensus_error=1.0))
    assert write(tmp_path / "asked", asked) == {}
