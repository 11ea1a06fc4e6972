"""The viewing diagram has everything where the result has it."""

import re

import numpy as np
import pytest
from carrying import carried
from pydrake.geometry import QueryObject, Rgba

from drake_formation import load_scenario, simulate
from drake_formation.viz.links import AT_REST, PRESSED, STRETCHED, moving_links, strain_colour, strains
from drake_formation.viz.playback import Playback
from drake_formation.viz.view import page
from drake_formation.viz.view.page import quiet_meshcat
from drake_formation.viz.view.recording import ROOT, record, viewing_diagram
from drake_formation.viz.view.trails import ribbon

KINDS = "{kind: {1: unicycle, 2: omnidirectional, default: point_mass}, start: {centre: [2, 3]}, heading: 30}"


@pytest.fixture(scope="module")
def result():
    return simulate(carried("{kind: rigid}", robots=KINDS), engine="blocks")


@pytest.mark.parametrize("sample", [0, -1])
def test_frames_are_at_the_results_poses(result, sample):
    playback = Playback(result)
    colours = dict.fromkeys(range(1, 5), (1.0, 0.0, 0.0, 1.0))
    with quiet_meshcat() as meshcat:
        diagram = viewing_diagram(playback, meshcat, moving_links(playback), colours)
    context = diagram.CreateDefaultContext()
    context.SetTime(float(result.time[sample]))
    scene = diagram.GetSubsystemByName("scene_graph")
    query: QueryObject = scene.get_query_output_port().Eval(scene.GetMyContextFromRoot(context))
    inspector = query.inspector()
    frames = {inspector.GetName(frame): query.GetPoseInWorld(frame) for frame in inspector.GetAllFrameIds()}
    expected = {"object": result.object_pose.values[sample, :3]}
    for i, (x, y) in enumerate(result.position.values[sample]):
        expected[f"robot_{i + 1}"] = (x, y, np.nan_to_num(result.heading.values[sample, i]))
    for name, (x, y, heading) in expected.items():
        np.testing.assert_allclose(frames[name].translation(), [x, y, 0.0], atol=1e-12)
        np.testing.assert_allclose(frames[name].rotation().ToRollPitchYaw().yaw_angle(), heading, atol=1e-12)


def test_a_second_recording_replaces_the_first(result):
    with quiet_meshcat() as meshcat:
        record(result, meshcat)
        first = meshcat.StaticHtml()
        meshcat.SetLine(f"{ROOT}/left over", np.eye(3), 1.0, Rgba(0, 0, 0, 1))
        record(result, meshcat)
        assert not meshcat.HasPath(f"{ROOT}/left over")
        assert len(meshcat.StaticHtml()) == pytest.approx(len(first), rel=0.01)


@pytest.mark.parametrize("follow", [False, True])
def test_a_page_needs_nothing_else(result, follow):
    text = page(result, follow=follow)
    assert not re.findall(r'(?:src|href)\s*=\s*"(?!data:)[^"#]+"', re.sub(r"<script.*?</script>", "", text, flags=re.S))
    assert not re.findall(r"<script[^>]*\bsrc", text)
    assert "<title>carried</title>" in text
    assert len(text) < 5e6


@pytest.mark.parametrize("overrides", [{"robots": 1}, {"end": 1}])
def test_next_to_nothing_is_a_page_too(overrides):
    alone = {"formation": {"shape": "line", "robots": overrides.get("robots", 2), "side": 1.0}}
    quick = {"robots.start": {"centre": [2.5, 3.5]}, "aggregation.duration": 0.5, "transport.duration": 0.5}
    result = simulate(load_scenario("line", overrides=alone | quick))
    assert "viewer" in page(result.isel(time=slice(overrides.get("end"))))


def test_the_colour_of_a_spring_tells_its_strain():
    assert strain_colour(0.0) == tuple(AT_REST)
    np.testing.assert_allclose(strain_colour(1.0), STRETCHED)
    np.testing.assert_allclose(strain_colour(-2.0), PRESSED)


def test_strains_are_of_the_results_springs():
    result = simulate(carried("{kind: springs}"), engine="blocks")
    playback = Playback(result)
    links = moving_links(playback)
    of_springs = [k for k, link in enumerate(links) if link.rest_length is not None]
    shown = strains(links, playback.points(result.time.values))[:, of_springs]
    np.testing.assert_allclose(shown, result.spring_length / result.rest_length - 1.0, atol=1e-9)


def test_a_ribbon_runs_on_both_sides_of_its_way():
    places = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]])
    vertices, faces = ribbon(places, 0.1)
    np.testing.assert_allclose(0.5 * (vertices[:2, 0::2] + vertices[:2, 1::2]), places.T)
    assert set(vertices[2]) == {0.1}
    assert faces.shape == (3, 4)
    assert faces.max() == 5
