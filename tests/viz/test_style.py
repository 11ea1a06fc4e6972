"""Figures are in this project's own style, and one that fails costs only itself."""

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from drake_formation.viz.style import attempt_each, draw, draw_each

ODD = {
    "text.usetex": True,
    "font.family": ["No Such Font"],
    "savefig.dpi": 100000,
    "figure.dpi": 100000,
    "agg.path.chunksize": 3,
    "savefig.format": "pdf",
    "figure.figsize": (1000, 1000),
    "axes.prop_cycle": mpl.cycler(color=["red"]),
    "axes.formatter.use_locale": True,
    "path.sketch": (10, 10, 10),
    "savefig.bbox": "tight",
}


def figure():
    made = Figure(figsize=(3, 2), layout="constrained")
    axes = made.subplots()
    axes.plot([0, 1], [1, 1000])
    axes.set(yscale="log", title="δ", xlabel="time (s)")
    return made


@pytest.mark.parametrize("setting", ODD)
def test_no_setting_of_a_user_changes_a_figure(tmp_path, setting):
    draw(figure, tmp_path / "plain.png")
    with mpl.rc_context({setting: ODD[setting]}):
        draw(figure, tmp_path / "odd.png")
        assert mpl.rcParams[setting] != mpl.rcParamsDefault[setting]
    assert (tmp_path / "odd.png").read_bytes() == (tmp_path / "plain.png").read_bytes()


@pytest.mark.parametrize("title", ["日本", "a_b", "\N{SNOWMAN}"])
@pytest.mark.filterwarnings("error")
def test_letters_that_the_font_lacks_are_no_reason_to_complain(tmp_path, title):
    def titled():
        made = figure()
        made.suptitle(title)
        return made

    draw(titled, tmp_path / "a.png")
    assert (tmp_path / "a.png").exists()


def test_a_figure_that_fails_is_named_and_leaves_no_file(tmp_path):
    def unfinished():
        (tmp_path / "bad.png").write_bytes(b"half")
        raise RuntimeError("latex was not found\nand much more")

    assert draw_each({"bad": unfinished, "good": figure}, tmp_path) == {"bad": "latex was not found"}
    assert [path.name for path in tmp_path.iterdir()] == ["good.png"]


def test_a_failure_without_a_word_is_told_by_its_kind():
    def fail():
        raise MemoryError

    assert attempt_each({"a": fail}) == {"a": "MemoryError"}


def test_an_interruption_is_no_failure_of_a_figure(tmp_path):
    def interrupted():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        draw_each({"a": interrupted}, tmp_path)
