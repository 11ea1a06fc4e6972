"""Sliders run a scenario anew and redraw what becomes of it; tried without a browser, by moving them from Python."""

import io
import sys

import numpy as np
import pytest
from PIL import Image
from short_runs import SECONDS
from shown import Shown

from drake_formation import interactive, load_scenario, metrics, simulate, with_overrides
from drake_formation.interactive import panel, runs
from drake_formation.optional import MissingPackageError

PACKETS = {"kind": "packets", "period": 0.1, "loss": 0.25, "burst": 5.0}


@pytest.fixture(scope="module")
def line():
    return load_scenario("line", overrides=SECONDS)


def pixels(png):
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def test_a_slider_shows_the_run_of_the_scenario_it_says(line):
    shown = panel(line)
    assert {path: slider.value for path, slider in shown.sliders.items()} == {
        "consensus.delta": 0.0, "consensus.delta_v": 0.0, "springs.stiffness": pytest.approx(1.45)
    }  # fmt: skip
    assert interactive.panel is panel  # and no module of its name
    before = shown.picture
    shown.sliders["consensus.delta"].value = 100.0
    shown.sliders["springs.stiffness"].value = 1e3
    expected = with_overrides(line, {"consensus.delta": 100.0, "springs.stiffness": 1e3})
    assert shown.scenario == expected
    assert shown.result.equals(simulate(expected, engine="compiled"))
    assert "run and drawn in" in shown.line
    assert f"{metrics(shown.result).peak_force_n:.4g}" in Shown(shown.children[-2].value).texts
    assert (pixels(shown.picture) != pixels(before)).any()
    shown.sliders["consensus.delta"].value = 0.0
    shown.sliders["springs.stiffness"].value = 1.45
    assert shown.scenario == line


def test_what_is_drawn_anew_is_the_same_as_if_all_were(line):
    shown = panel(line)
    for delta in (100.0, 1e4, 10.0):
        shown.sliders["consensus.delta"].value = delta
    shown._drawing._background = None
    assert shown._drawing.drawn(shown._series) == shown.picture


@pytest.mark.slow
def test_the_loss_of_packets_has_a_slider_where_there_are_packets():
    lossy = load_scenario("line", overrides=SECONDS | {"consensus.channel": PACKETS})
    shown = panel(lossy)
    assert shown.sliders["consensus.channel.loss"].value == 0.25
    shown.sliders["consensus.channel.loss"].value = 0.0
    assert metrics(shown.result).messages_lost == 0
    assert len(shown._runs._prepared) == 1  # the same diagram ran both
    before = shown.picture
    shown.sliders["consensus.channel.loss"].value = 0.9  # while times are good for less than a packet
    assert "good times would be shorter than one packet" in shown.line
    assert shown.picture == before
    assert shown.scenario.consensus.channel.loss == 0.0


def test_a_run_that_takes_too_long_is_given_up(line, monkeypatch):
    shown = panel(line)
    monkeypatch.setattr(runs, "PATIENCE", -1.0)
    shown.sliders["consensus.delta"].value = 10.0
    assert "given up" in shown.line
    assert shown.scenario.consensus.delta == 0.0


def test_numbers_of_single_robots_have_no_slider(line):
    shown = panel(with_overrides(line, {"consensus.delta": {"1": 5.0, "default": 6.0}}))
    assert set(shown.sliders) == {"consensus.delta_v", "springs.stiffness"}


def test_without_ipywidgets_the_command_that_brings_it_is_named(line, monkeypatch):
    monkeypatch.setitem(sys.modules, "ipywidgets", None)
    with pytest.raises(MissingPackageError, match=r"pip install 'drake-formation\[notebook\]'"):
        panel(line)
