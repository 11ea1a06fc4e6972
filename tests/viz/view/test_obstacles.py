"""Obstacles of any shape are seen where they are, and so are springs that broke and channels that fell silent."""

import numpy as np
import pytest
from pydrake.geometry import CalcVolume

from drake_formation import load_scenario, simulate
from drake_formation.viz import animate
from drake_formation.viz.links import moving_links, present
from drake_formation.viz.playback import Playback
from drake_formation.viz.view.obstacles import prism
from drake_formation.viz.view.page import quiet_meshcat
from drake_formation.viz.view.recording import viewing_diagram

NOTCHED = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [1.5, 0.5], [0.0, 2.0], [0.0, 0.0]])
MOVING = [
    {"kind": "segment", "ends": [[10.0, 6.0], [12.0, 6.0]], "radius": 0.2, "velocity": [0.5, 0.0], "start": 1.0},
    {"kind": "polygon", "vertices": [[6.0, 8.0], [7.0, 8.0], [6.5, 9.0]]},
]
SHORT = {"aggregation.duration": 1.0, "transport.duration": 2.0}


@pytest.mark.parametrize("outline", [NOTCHED, NOTCHED[::-1]])
def test_a_prism_fills_its_outline_and_not_its_notch(outline):
    x, y = NOTCHED.T
    area = 0.5 * abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
    assert CalcVolume(prism(outline, 0.6)) == pytest.approx(0.6 * area)


def test_obstacles_of_any_shape_are_where_they_have_moved_in_the_view_and_in_the_film():
    result = simulate(load_scenario("line", overrides=SHORT | {"avoidance.obstacles": MOVING}))
    playback = Playback(result)
    np.testing.assert_allclose(playback.moved(np.array([0.0, 3.0])), [[[0, 0], [0, 0]], [[1, 0], [0, 0]]])
    _, high = playback.seen(playback.positions(np.array([0.0])))
    assert high[0] >= 13.2
    assert high[1] >= 9.0
    with quiet_meshcat() as meshcat:
        colours = dict.fromkeys(range(1, 3), (1.0, 0.0, 0.0, 1.0))
        diagram = viewing_diagram(playback, meshcat, moving_links(playback), colours)
    context = diagram.CreateDefaultContext()
    context.SetTime(3.0)
    scene = diagram.GetSubsystemByName("scene_graph")
    query = scene.get_query_output_port().Eval(scene.GetMyContextFromRoot(context))
    inspector = query.inspector()
    frames = {inspector.GetName(frame): frame for frame in inspector.GetAllFrameIds()}
    np.testing.assert_allclose(query.GetPoseInWorld(frames["obstacle_1"]).translation(), [1, 0, 0], atol=1e-12)
    assert "obstacle_2" not in frames  # it is at rest
    film = animate(result, seconds=0.2)
    film._picture.show(len(film.times) - 1)
    (wall, *_) = film._picture._obstacles[0]
    corners = (
        film.figure.axes[0].transData.inverted().transform(wall.get_transform().transform(wall.get_path().vertices))
    )
    assert corners[:, 0].max() == pytest.approx(13.2, abs=1e-3)


def test_a_spring_that_broke_is_gone():
    overrides = {
        "aggregation.duration": 0.5,
        "transport.duration": 0.5,
        "object": {"kind": "springs", "look_every": 0.02},
    }
    stiff = {"springs.break_at_strain": 0.05, "robots.start": [[0.8, 5.1], [0.25, 2.45], [2.6, 2.0], [3.1, 4.5]]}
    result = simulate(load_scenario("quadrilateral", overrides=overrides | stiff), engine="blocks")
    assert np.isfinite(result.broken_at).any()
    playback = Playback(result)
    springs = [link for link in moving_links(playback) if link.spring is not None]
    shown = present(playback, springs, result.time.values)
    np.testing.assert_array_equal(shown, (result.acting.values == 1) & (result.phase.values == 1)[:, None])
