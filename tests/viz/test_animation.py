"""A film shows a result from its first sample to its last, and is written as its file ends."""

import numpy as np
import pytest
from PIL import Image

from drake_formation import load_scenario, simulate
from drake_formation.viz import animate, animation
from drake_formation.viz.errors import FilmError

SHORT = {"aggregation.duration": 2.0, "transport.duration": 3.0}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=SHORT))


@pytest.fixture(scope="module")
def film(result):
    return animate(result, seconds=0.3)


def test_pictures_run_from_the_first_sample_to_the_last(film, result):
    assert film.times[0] == result.time[0]
    assert film.times[-1] == result.time[-1]
    assert len(film.times) == round(0.3 * animation.RATE) + 1


def test_a_picture_has_the_robots_where_they_are_then(film, result):
    film._picture.show(len(film.times) - 1)
    (axes,) = film.figure.axes
    dots = [line.get_xydata()[0] for line in axes.lines if line.get_marker() == "o"]
    np.testing.assert_allclose(dots, result.position[-1])
    assert "carrying, 5.0 s" in axes.get_title()


def test_springs_are_there_once_the_object_is_carried(film):
    (axes,) = film.figure.axes
    (springs,) = (artist for artist in axes.collections if hasattr(artist, "get_segments"))
    counts = []
    for number in (0, len(film.times) - 1):
        film._picture.show(number)
        counts.append(len(springs.get_segments()))
    assert counts == [0, 1]


def test_a_gif_has_every_picture(film, tmp_path):
    film.save(tmp_path / "film.gif")
    with Image.open(tmp_path / "film.gif") as gif:
        assert gif.n_frames == len(film.times)
        first = np.asarray(gif.convert("RGB")).copy()
        gif.seek(gif.n_frames - 1)
        assert (np.asarray(gif.convert("RGB")) != first).any()


def test_an_mp4_is_one(film, tmp_path):
    film.save(tmp_path / "film.mp4")
    assert (tmp_path / "film.mp4").read_bytes()[4:8] == b"ftyp"


def test_a_notebook_shows_a_video_or_pictures_without_ffmpeg(film, monkeypatch):
    assert "<video" in film._repr_html_()
    monkeypatch.setattr(animation, "ffmpeg", lambda: None)
    assert "<script" in film._repr_html_()


def test_what_cannot_be_written_is_refused_by_name(film, tmp_path, monkeypatch):
    with pytest.raises(FilmError, match=r"film\.avi.*\.mp4 or \.gif"):
        film.save(tmp_path / "film.avi")
    monkeypatch.setattr(animation, "ffmpeg", lambda: None)
    with pytest.raises(FilmError, match=r"film\.mp4 needs ffmpeg.*drake-formation\[video\]"):
        film.save(tmp_path / "film.mp4")


def test_a_film_without_length_is_refused(result):
    with pytest.raises(ValueError, match="no length"):
        animate(result, seconds=0.0)
