"""What a real browser shows of a recording: one for all, with a page of a run in which links and a robot fail."""

import webbrowser
from _thread import interrupt_main
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from time import sleep

import numpy as np
import pytest
from browsing import opened, page_address

from drake_formation import load_scenario, simulate
from drake_formation.simulation import PreparedRun
from drake_formation.viz.figures import robot_colours
from drake_formation.viz.playback import Playback
from drake_formation.viz.view import write_page
from drake_formation.viz.view.flights import drawn_packets
from drake_formation.viz.view.frames import TOLERANCE
from drake_formation.viz.view.knobs import KNOBS
from drake_formation.viz.view.session import AGAIN, CLOSE

pytestmark = pytest.mark.slow

SHORT = {"aggregation.duration": 2.0, "transport.duration": 4.0, "consensus.delta": 40.0}
LOSING = {"kind": "packets", "period": 0.25, "delay": 0.2, "losses": [0, 1], "outages": {"1-2": [[3, 6]]}}
FAILING = SHORT | {
    "consensus.channel": LOSING,
    "failures": [{"robot": 2, "time": 4.5, "kind": "stops_actuating"}],
}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=FAILING), engine="blocks")


@pytest.fixture(scope="module")
def playback(result):
    return Playback(result)


@pytest.fixture(scope="module")
def view(result, tmp_path_factory):
    path = tmp_path_factory.mktemp("view") / "line.html"
    write_page(result, path)
    with opened(page_address(path), offline=True) as view:
        yield view


def robot(number):
    return f"formation/bodies/robot_{number}"


def test_the_page_loads_without_a_network_and_nothing_is_on_the_console(view):
    assert view.duration() == pytest.approx(6.0, abs=1 / 64)
    assert view.driver.title == "line"
    view.scrub(3.0)
    assert view.complaints() == []
    asked = view.driver.execute_script("return performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert [name for name in asked if not name.startswith(("data:", "blob:", "file:"))] == []


@pytest.mark.parametrize("time", [0.0, 3.0, 6.0])
def test_scrubbing_moves_the_robots_to_where_they_are_then(view, result, time):
    view.scrub(time)
    expected = result.position.interp(time=time)
    for number in (1, 2):
        shown = view.where(robot(number))
        np.testing.assert_allclose([shown["x"], shown["y"]], expected.sel(robot=number), atol=5e-3)


def test_the_robots_are_in_the_picture_in_their_colours(view, result):
    view.scrub(3.0)
    picture = view.picture()
    for number, colour in robot_colours(result).items():
        place = view.where(robot(number), height=0.08)
        pixel = picture[round(place["row"]), round(place["column"])] / 255
        direction = np.array(colour[:3]) / np.linalg.norm(colour[:3])
        assert pixel @ direction / np.linalg.norm(pixel) > 0.97, (pixel, colour)  # of that hue, in light or shade


def test_springs_are_there_from_the_hand_off_on_and_as_long_as_they_are(view, playback):
    view.scrub(1.5)
    assert not view.where("formation/springs/1-2")["shown"]
    view.scrub(3.5)
    assert view.where("formation/springs/1-2")["shown"]
    find = "return viewer.scene_tree.find(['formation', 'springs', '1-2']).object.scale.x"
    ((one, other),) = playback.positions(np.array([3.5]))
    assert view.driver.execute_script(find) == pytest.approx(np.linalg.norm(one - other), abs=1.5 * TOLERANCE)


@pytest.mark.parametrize(("lost", "group"), [(False, "flying"), (True, "lost")])
def test_packets_fly_from_who_speaks_to_who_hears_and_lost_ones_are_told_apart(view, playback, lost, group):
    packets = drawn_packets(playback)
    packets = packets.some(packets.lost == lost)
    children = "return Object.keys(viewer.scene_tree.find(['formation', 'packets', arguments[0]]).children).length"
    count = view.driver.execute_script(children, group)
    assert 0 < count <= packets.at_once + 1
    for time in (2.6, 2.85, 5.05):
        view.scrub(time)
        balls = [view.where(f"formation/packets/{group}/{ball + 1}") for ball in range(count)]
        shown = sorted((ball["x"], ball["y"]) for ball in balls if ball["shown"])
        under_way = packets.some(packets.under_way(time))
        expected = sorted(map(tuple, under_way.places(playback, np.full(len(under_way), time)).tolist()))
        np.testing.assert_allclose(np.reshape(shown, (-1, 2)), np.reshape(expected, (-1, 2)), atol=0.02)


def test_a_dead_link_is_thin_and_a_failed_robot_is_crossed_out_from_when_it_is(view):
    find = "return viewer.scene_tree.find(['formation', 'channels', arguments[0]]).object.scale.y"
    told = []
    for time in (1.5, 5.0):
        view.scrub(time)
        thin = [view.driver.execute_script(find, link) < 1 for link in ("1 to 2", "2 to 1")]
        told.append((*thin, *(view.where(f"{robot(number)}/failed")["shown"] for number in (1, 2))))
    assert told == [(False, False, False, False), (True, False, False, True)]


def test_events_are_on_the_line_of_time_and_a_click_goes_there(view, playback):
    marks = view.driver.find_elements("css selector", "#timeline i")
    assert [mark.get_attribute("data-kind") for mark in marks] == [event.kind for event in playback.events]
    assert [event.kind for event in playback.events] == ["hand_off", "failure"]
    marks[1].click()
    view.driver.execute_async_script("setTimeout(arguments[0], 200)")
    told = view.driver.find_element("id", "happened").text
    assert told.startswith("4.5")
    assert view.where("formation/events/1")["shown"] == ("robot 2 stops actuating" in told)
    view.scrub(4.4)
    assert not view.where("formation/events/1")["shown"]


SLIDE = "viewer.gui_controllers[arguments[0]].setValue(arguments[1])"
PRESS = "viewer.gui_controllers[arguments[0]].object[arguments[0]]()"
WAIT = """
const [control, done] = arguments;
(function look() {
    control in viewer.gui_controllers && viewer.animator.duration > 0 ? done() : setTimeout(look, 100);
})()
"""


def slid(view, address, expected):
    """Open a served view, run it with another δ, and say where a robot is then, as soon as that is expected."""
    delta, run = KNOBS[0], view.driver.execute_script
    try:
        view.go(address)
        view.driver.execute_async_script(WAIT, delta.label)
        run(SLIDE, delta.label, 400.0)
        run(PRESS, AGAIN)
        for _ in range(300):
            view.scrub(1.0)
            shown = view.where(robot(1))
            place = [shown["x"], shown["y"]]
            if np.allclose(place, expected, atol=5e-3):
                break
            sleep(0.2)
        run(PRESS, CLOSE)
    except BaseException:
        interrupt_main()
        raise
    return place


def test_sliders_act_on_the_next_run(view, cli, monkeypatch):
    simulate(load_scenario("line", overrides=SHORT), engine="blocks").to_netcdf("result.nc")
    other = simulate(load_scenario("line", overrides=SHORT | {"consensus.delta": 400.0}), engine="blocks")
    expected = other.position.interp(time=1.0).sel(robot=1)
    blocks = partial(PreparedRun, engine="blocks")  # compiling the line takes longer than all else here
    monkeypatch.setattr(PreparedRun, "compiled", staticmethod(blocks))
    with ThreadPoolExecutor() as aside:
        at_work = []
        monkeypatch.setattr(webbrowser, "open", lambda url: at_work.append(aside.submit(slid, view, url, expected)))
        status, out, _ = cli("view", "result.nc")
        np.testing.assert_allclose(at_work[0].result(), expected, atol=5e-3)
    assert status == 0
    assert "consensus.delta=400" in out
    assert out.count("the object is placed on the robots") == 2
