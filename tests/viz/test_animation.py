"""A film shows a result from its first sample to its last, and is written as its file ends."""

import numpy as np
import pytest
from PIL import Image

from drake_formation import load_scenario, simulate
from drake_formation.viz import animate, animation
from drake_formation.viz.errors import FilmError
from drake_formation.viz.packets import packets_of
from drake_formation.viz.playback import Playback

SECONDS = 0.1
SHORT = {"aggregation.duration": 2.0, "transport.duration": 3.0}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=SHORT), engine="blocks")


@pytest.fixture(scope="module")
def film(result):
    return animate(result, seconds=SECONDS)


def test_pictures_run_from_the_first_sample_to_the_last(film, result):
    assert film.times[0] == result.time[0]
    assert film.times[-1] == result.time[-1]
    assert len(film.times) == round(SECONDS * animation.RATE) + 1


def test_a_picture_has_the_robots_where_they_are_then(film, result):
    film._picture.show(len(film.times) - 1)
    (axes,) = film.figure.axes
    dots = [line.get_xydata()[0] for line in axes.lines if line.get_marker() == "o" and len(line.get_xydata())]
    np.testing.assert_allclose(dots, result.position[-1])
    assert "carrying, 5.0 s" in axes.get_title()


def test_springs_are_there_once_the_object_is_carried(film):
    (axes,) = film.figure.axes
    springs, _ = (artist for artist in axes.collections if hasattr(artist, "get_segments"))
    counts = []
    for number in (0, len(film.times) - 1):
        film._picture.show(number)
        counts.append(len(springs.get_segments()))
    assert counts == [0, 1]


@pytest.fixture(scope="module")
def failing():
    channel = {"kind": "packets", "period": 0.25, "delay": 0.2, "losses": [0, 1], "outages": {"1-2": [[2.0, 5.0]]}}
    failures = [{"robot": 2, "time": 4.0, "kind": "stops_actuating"}]
    overrides = SHORT | {"consensus.channel": channel, "failures": failures, "consensus.delta": 40.0}
    return simulate(load_scenario("line", overrides=overrides), engine="blocks")


@pytest.mark.parametrize("number", [1, 4, 5])
def test_a_picture_has_the_packets_that_are_under_way_then(failing, number):
    film, playback = animate(failing, seconds=0.3), Playback(failing)
    film._picture.show(number)
    packets = packets_of(playback)
    seen = packets.some(packets.under_way(film.times[number]))
    talk = film._picture._talk
    shown = [talk._flying.get_xydata(), talk._lost.get_xydata()]
    assert [len(places) for places in shown] == [int((seen.lost == lost).sum()) for lost in (False, True)]
    places = seen.places(playback, np.full(len(seen), film.times[number]))
    off = np.linalg.norm(np.concatenate(shown) - np.concatenate([places[~seen.lost], places[seen.lost]]), axis=1)
    one, other = playback.positions(film.times[[number]])[0]
    assert off.max(initial=0.0) <= 0.05 * np.linalg.norm(one - other)  # aside of the line between the robots


def test_dead_links_are_grey_failed_robots_are_crossed_out_and_events_are_told(failing):
    film = animate(failing, seconds=0.3)
    marks, told = film._picture._marks, []
    for number in (1, len(film.times) - 1):
        film._picture.show(number)
        silent = [tuple(colour[:3]) == (0.25, 0.25, 0.25) for colour in film._picture._talk._lines.get_color()]
        told.append((sorted(silent), len(marks._crosses.get_xydata()), len(marks._marks.get_xydata())))
    assert told == [([False, False], 0, 0), ([False, True], 1, 1)]
    np.testing.assert_allclose(marks._crosses.get_xydata(), failing.position[-1, 1:])
    assert film._picture._told.get_text() == "4 s: robot 2 stops actuating"


def test_a_film_that_follows_has_the_formation_in_the_middle_of_every_picture(failing):
    film = animate(failing, seconds=0.3, follow=True)
    (axes,) = film.figure.axes
    for number in (0, len(film.times) - 1):
        film._picture.show(number)
        middle = Playback(failing).positions(film.times[[number]])[0].mean(axis=0)
        np.testing.assert_allclose([np.mean(axes.get_xlim()), np.mean(axes.get_ylim())], middle)


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
