"""Every figure of a run is written, in the format asked for, whatever the run is without."""

import warnings

import pytest

from drake_formation import load_scenario, simulate
from drake_formation.viz.figures import FIGURES, consensus_error, write_figures
from drake_formation.viz.style import draw

QUICK = {"aggregation.duration": 3.0, "transport.duration": 8.0, "robots.start": {"centre": [2.5, 3.5]}}
AT_REST = {"aggregation.duration": 0.0, "transport.goal": [2.5, 3.5]}
MAGIC = {"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=QUICK))


def test_every_figure_is_written(result, tmp_path):
    assert write_figures(result, tmp_path, "svg") == {}
    assert {path.name for path in tmp_path.iterdir()} == {f"{name}.svg" for name in FIGURES}


@pytest.mark.parametrize("file_format", MAGIC)
def test_a_figure_drawn_again_is_the_same_file(result, tmp_path, file_format):
    files = [tmp_path / f"{name}.{file_format}" for name in ("once", "again")]
    for file in files:
        draw(lambda: consensus_error(result), file)
    once, again = (file.read_bytes() for file in files)
    assert once == again
    assert once.startswith(MAGIC[file_format])


def test_another_format_is_refused(result, tmp_path):
    with pytest.raises(ValueError, match="'gif' of figures; there are png, pdf, svg"):
        write_figures(result, tmp_path, "gif")


@pytest.mark.parametrize(
    "overrides",
    [
        {"avoidance.obstacles": []},
        {"springs.graph": []},
        {"aggregation.duration": 0.0},
        {"formation": {"shape": "line", "robots": 1, "side": 1.0}},
        {"formation": {"shape": "line", "robots": 1, "side": 1.0}, **AT_REST, "avoidance.obstacles": []},
        AT_REST,
        {**AT_REST, "consensus.graph": [], "springs.graph": []},
        {**AT_REST, "transport.goal": [1e6, 1e6], "robots.start": {"centre": [1e6, 1e6]}},
        {"transport.duration": 1e-9},
        {"transport.duration": 1e-6, "aggregation.duration": 1e-9},
        {"robots.mass": 1e12},
        {"robots.mass": 1e-6, "tracking.R": 1e9},
        {"springs.stiffness": 0.0, "consensus.delta": 1e6},
        {"formation": {"shape": "line", "robots": 12, "side": 1e-3}},
    ],
)
def test_figures_of_what_is_missing_are_drawn_too(overrides, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert write_figures(simulate(load_scenario("line", overrides={**QUICK, **overrides})), tmp_path) == {}
