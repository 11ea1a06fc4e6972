"""A result for Foxglove: an MCAP file whose 3D panel shows it, and whose plots have every number."""

import heapq
import json
from collections.abc import Iterable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from drake_formation.exporting import foxglove
from drake_formation.exporting.foxglove import LINE_STRIP, Message
from drake_formation.exporting.foxglove_schemas import FRAME_TRANSFORMS, SCENE_UPDATE, Schema
from drake_formation.exporting.scene import WORLD, Scene
from drake_formation.exporting.signals import Signals, signals
from drake_formation.optional import required

if TYPE_CHECKING:
    import xarray as xr

SPRING_THICKNESS, CHANNEL_THICKNESS, PATH_THICKNESS = 0.05, 0.02, 0.03
"""Of lines (m)."""


class Told(NamedTuple):
    """A message of a topic."""

    time: int  # ns
    topic: str
    message: Message


def write_mcap(result: "xr.Dataset", path: str | Path) -> None:
    """Write a result as Foxglove opens it; times count from 1970 as the run's count from its clock's zero.

    Topics are ``/tf``, where robots, object and obstacles are, ``/scene``, ``/paths``, ``/springs`` and ``/channels``,
    what is seen, twenty times a second; and at every sample ``/robot_1`` and so on, ``/spring_numbers``,
    ``/channel_numbers`` and ``/formation``, the numbers, each in the unit that its schema's description says. The
    scenario is attached.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
        path: where; Foxglove wants it to end in .mcap.

    Raises:
        MissingPackageError: the package mcap is not installed.
        ValueError, ScenarioError: it is not a result of this version.
        OSError: it cannot be written.
    """
    writing = required("mcap.writer", "export")
    scene, told = Scene(result), list(signals(result))
    schemas: dict[str, tuple[str, Schema]] = {"/tf": ("foxglove.FrameTransforms", FRAME_TRANSFORMS)}
    schemas |= dict.fromkeys(("/scene", "/paths"), ("foxglove.SceneUpdate", SCENE_UPDATE))
    schemas |= {f"/{name}": ("foxglove.SceneUpdate", SCENE_UPDATE) for name, _ in scene.lines()}
    schemas |= {f"/{signal.topic}": (f"drake_formation.{signal.topic}", _schema(signal)) for signal in told}
    with Path(path).open("wb") as file:
        writer = writing.Writer(file)
        writer.start(profile="", library=f"drake-formation {version('drake-formation')}")
        channels = {topic: _channel(writer, topic, *schema) for topic, schema in schemas.items()}
        streams = [_still(scene), _moving(scene), *(_lines(scene)), *(_numbers(signal) for signal in told)]
        for time, topic, message in heapq.merge(*streams, key=lambda item: item.time):
            text = json.dumps(message, allow_nan=False, separators=(",", ":"))
            writer.add_message(channels[topic], log_time=time, publish_time=time, data=text.encode())
        scenario = str(result.attrs["scenario"]).encode()
        writer.add_attachment(0, 0, "scenario.yaml", "application/yaml", scenario)
        writer.finish()


def _channel(writer: Any, topic: str, name: str, schema: Schema) -> int:
    number = writer.register_schema(name=name, encoding="jsonschema", data=json.dumps(schema).encode())
    channel: int = writer.register_channel(topic=topic, message_encoding="json", schema_id=number)
    return channel


def _nanoseconds(times: Iterable[float]) -> list[int]:
    return [round(time * 1e9) for time in times]


def _still(scene: Scene) -> Iterator[Told]:
    """What is fixed to frames, and the paths, once."""
    time = round(scene.playback.begin * 1e9)
    entities = [foxglove.entity(n, frame, time, **foxglove.primitives(own)) for n, frame, own in scene.bodies()]
    yield Told(time, "/scene", foxglove.scene_update(entities))
    paths = []
    for robot, points in scene.paths.items():
        line = foxglove.lines(points, PATH_THICKNESS, np.array(scene.colours[robot]), LINE_STRIP)
        paths.append(foxglove.entity(f"path_{robot}", WORLD, time, lines=[line]))
    yield Told(time, "/paths", foxglove.scene_update(paths))


def _moving(scene: Scene) -> Iterator[Told]:
    """Where all frames are."""
    for k, time in enumerate(_nanoseconds(scene.times)):
        there = [foxglove.transform(time, name, *poses[k].tolist()) for name, poses in scene.frames.items()]
        yield Told(time, "/tf", {"transforms": there})


def _lines(scene: Scene) -> list[Iterator[Told]]:
    """Springs and channels."""
    times = _nanoseconds(scene.times)

    def told(name: str, pictures: list[Any]) -> Iterator[Told]:
        thickness = SPRING_THICKNESS if name == "springs" else CHANNEL_THICKNESS
        for time, lines in zip(times, pictures, strict=True):
            drawn = foxglove.lines(lines.ends.reshape(-1, 3), thickness, np.repeat(lines.colours, 2, axis=0))
            yield Told(time, f"/{name}", foxglove.scene_update([foxglove.entity(name, WORLD, time, lines=[drawn])]))

    return [told(name, pictures) for name, pictures in scene.lines()]


def _schema(signal: Signals) -> Schema:
    """The schema of a topic of numbers; what is not a number at some time is left out then."""
    fields = {name: {"type": "number", "description": unit} for name, unit in signal.units.items()}
    return {"title": f"drake_formation.{signal.topic}", "type": "object", "properties": fields}


def _numbers(signal: Signals) -> Iterator[Told]:
    names = list(signal.units)
    for time, row in zip(_nanoseconds(signal.times), signal.values.tolist(), strict=True):
        yield Told(time, f"/{signal.topic}", {n: v for n, v in zip(names, row, strict=True) if np.isfinite(v)})
