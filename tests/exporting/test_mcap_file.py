"""What Foxglove opens is the result: where everything is, and every number."""

import json

import jsonschema
import numpy as np
import pytest
from carrying import carried
from mcap.reader import make_reader
from short_runs import lossy, short

from drake_formation import simulate
from drake_formation.optional import MissingPackageError

THE_OBJECT = "{kind: rigid, mass: 20.0}"


def told(result, path):
    """Messages by topic, each with its time (s); every one is checked against the schema in the file."""
    result.formation.to_mcap(path)
    found, checks = {}, {}
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        for schema, channel, message in reader.iter_messages():
            content = json.loads(message.data)
            check = checks.setdefault(schema.id, jsonschema.Draft202012Validator(json.loads(schema.data)))
            assert check.is_valid(content)
            found.setdefault(channel.topic, []).append((message.log_time / 1e9, content))
        (attachment,) = reader.iter_attachments()
    assert attachment.data.decode() == result.attrs["scenario"]
    return found


def entities(messages):
    return {entity["id"]: entity for _, update in messages for entity in update["entities"]}


def test_robots_are_where_they_are_and_their_numbers_are_those_of_the_result(tmp_path):
    result = short()
    topics = told(result, tmp_path / "run.mcap")
    for which in (0, -1):
        time, message = topics["/tf"][which]
        assert time == result["time"].values[which]
        places = {t["child_frame_id"]: (t["translation"]["x"], t["translation"]["y"]) for t in message["transforms"]}
        at = result["position"].isel(time=which)
        assert places == {f"robot_{i}": tuple(at.sel(robot=i).values.tolist()) for i in (1, 2)}
    forces = [message["control_force_x"] for _, message in topics["/robot_2"]]
    assert np.array_equal(forces, result["control_force"].sel(robot=2, axis="x"))
    assert "deviation_x" not in topics["/robot_2"][0][1]  # there is none before the hand-off
    assert "deviation_x" in topics["/robot_2"][-1][1]
    assert {"spring_length_spring_1_2"} == set(topics["/spring_numbers"][0][1])


def test_the_scene_has_robots_goals_obstacles_springs_and_channels(tmp_path):
    topics = told(short(), tmp_path / "run.mcap")
    seen = entities(topics["/scene"])
    assert set(seen) == {"robot_1", "robot_2", "goal_1", "goal_2", "obstacle_1", "obstacle_2"}
    assert seen["robot_1"]["frame_id"] == "robot_1"
    assert seen["robot_1"]["frame_locked"]
    assert seen["robot_1"]["cylinders"]
    assert seen["obstacle_1"]["frame_id"] == "world"
    before, after = topics["/springs"][0][1], topics["/springs"][-1][1]
    assert before["entities"][0]["lines"][0]["points"] == []  # nothing is carried yet
    (line,) = after["entities"][0]["lines"]
    assert len(line["points"]) == len(line["colors"]) == 2
    assert len(topics["/channels"][0][1]["entities"][0]["lines"][0]["points"]) == 4  # both ways


def test_a_rigid_object_is_made_of_triangles_in_a_frame_of_its_own(tmp_path):
    topics = told(simulate(carried(THE_OBJECT), engine="blocks"), tmp_path / "run.mcap")
    (solid,) = entities(topics["/scene"])["object"]["triangles"]
    corners = np.array([[p["x"], p["y"], p["z"]] for p in solid["points"]]).reshape(-1, 3, 3)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.linalg.norm(normals[np.isclose(abs(normals[:, 2]), np.linalg.norm(normals, axis=1))], axis=1).sum()
    assert area == pytest.approx(2 * (2.0**2 + 4 * 2.0 * 0.12 + np.pi * 0.12**2), rel=0.01)  # above and below
    assert "object" in {t["child_frame_id"] for t in topics["/tf"][0][1]["transforms"]}
    assert "object_pose_heading" in topics["/formation"][0][1]


def test_what_channels_tell_is_there(tmp_path):
    numbers = told(lossy(), tmp_path / "run.mcap")["/channel_numbers"]
    assert numbers[-1][1]["traffic_channel_1_2_sent"] > 0


def test_a_missing_package_is_named_with_what_brings_it(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "mcap.writer", None)
    with pytest.raises(MissingPackageError, match=r"pip install 'drake-formation\[export\]'"):
        short().formation.to_mcap(tmp_path / "run.mcap")
