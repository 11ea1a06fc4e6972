"""What a real browser shows of a recording."""

import subprocess
import sys
from time import sleep

import numpy as np
import pytest
from browsing import opened, page_address

from drake_formation import load_scenario, simulate
from drake_formation.viz.figures import robot_colours
from drake_formation.viz.playback import Playback
from drake_formation.viz.view import write_page
from drake_formation.viz.view.frames import TOLERANCE
from drake_formation.viz.view.knobs import KNOBS
from drake_formation.viz.view.session import AGAIN, CLOSE

pytestmark = pytest.mark.slow

SHORT = {"aggregation.duration": 4.0, "transport.duration": 12.0, "consensus.delta": 40.0}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=SHORT))


@pytest.fixture(scope="module")
def view(result, tmp_path_factory):
    path = tmp_path_factory.mktemp("view") / "line.html"
    write_page(result, path)
    with opened(page_address(path)) as view:
        yield view


def robot(number):
    return f"formation/bodies/robot_{number}"


def test_the_page_loads_and_nothing_is_on_the_console(view, result):
    assert view.duration() == pytest.approx(16.0, abs=1 / 64)
    assert view.driver.title == "line"
    view.scrub(8.0)
    assert view.complaints() == []


@pytest.mark.parametrize("time", [0.0, 4.0, 10.0, 16.0])
def test_scrubbing_moves_the_robots_to_where_they_are_then(view, result, time):
    view.scrub(time)
    expected = result.position.interp(time=time)
    for number in (1, 2):
        shown = view.where(robot(number))
        np.testing.assert_allclose([shown["x"], shown["y"]], expected.sel(robot=number), atol=5e-3)


@pytest.mark.parametrize("time", [2.0, 14.0])
def test_the_robots_are_in_the_picture_in_their_colours(view, result, time):
    view.scrub(time)
    picture = view.picture()
    for number, colour in robot_colours(result).items():
        place = view.where(robot(number), height=0.08)
        pixel = picture[round(place["row"]), round(place["column"])] / 255
        direction = np.array(colour[:3]) / np.linalg.norm(colour[:3])
        assert pixel @ direction / np.linalg.norm(pixel) > 0.97, (pixel, colour)  # of that hue, in light or shade


def test_springs_are_there_from_the_hand_off_on_and_as_long_as_they_are(view, result):
    view.scrub(3.0)
    assert not view.where("formation/springs/1-2")["shown"]
    view.scrub(8.0)
    assert view.where("formation/springs/1-2")["shown"]
    find = "return viewer.scene_tree.find(['formation', 'springs', '1-2']).object.scale.x"
    ((one, other),) = Playback(result).positions(np.array([8.0]))
    assert view.driver.execute_script(find) == pytest.approx(np.linalg.norm(one - other), abs=1.5 * TOLERANCE)


SLIDE = "viewer.gui_controllers[arguments[0]].setValue(arguments[1])"
PRESS = "viewer.gui_controllers[arguments[0]].object[arguments[0]]()"
WAIT = """
const [control, done] = arguments;
(function look() {
    control in viewer.gui_controllers && viewer.animator.duration > 0 ? done() : setTimeout(look, 100);
})()
"""


def test_sliders_act_on_the_next_run(result, tmp_path):
    result.to_netcdf(tmp_path / "result.nc")
    command = [sys.executable, "-m", "drake_formation", "view", str(tmp_path / "result.nc"), "--no-browser"]
    delta = KNOBS[0]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as served:
        try:
            with opened(served.stdout.readline().split("at ")[1].split(";")[0]) as view:
                run = view.driver.execute_script
                view.driver.execute_async_script(WAIT, delta.label)
                run(SLIDE, delta.label, 400.0)
                run(PRESS, AGAIN)
                assert "consensus.delta=400" in served.stdout.readline()
                other = simulate(load_scenario("line", overrides=SHORT | {"consensus.delta": 400.0}))
                expected = other.position.interp(time=2.0).sel(robot=1)
                for _ in range(50):  # until the recording is there
                    view.scrub(2.0)
                    shown = view.where(robot(1))
                    if np.allclose([shown["x"], shown["y"]], expected, atol=5e-3):
                        break
                    sleep(0.2)
                np.testing.assert_allclose([shown["x"], shown["y"]], expected, atol=5e-3)
                run(PRESS, CLOSE)
                assert served.wait(30) == 0
        finally:
            served.kill()
