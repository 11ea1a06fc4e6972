"""A result for Rerun: a recording of what is seen, and of every number."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drake_formation.exporting.scene import WORLD, Lines, Scene
from drake_formation.exporting.shapes import Piece
from drake_formation.exporting.signals import signals
from drake_formation.optional import required

if TYPE_CHECKING:
    import xarray as xr

TIMELINE = "run"
"""The timeline of a recording (s)."""

THICKNESS = 0.02
"""Of lines (m)."""


def write_rrd(result: "xr.Dataset", path: str | Path) -> None:
    """Write a result as Rerun opens it.

    Under ``world`` is what is seen, twenty times a second, and under ``robot_1`` and so on, ``formation``,
    ``spring_numbers`` and ``channel_numbers`` is every number at every sample, on the timeline ``run`` (s).

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
        path: where; Rerun wants it to end in .rrd.

    Raises:
        MissingPackageError: the package rerun-sdk is not installed.
        ValueError, ScenarioError: it is not a result of this version.
        OSError: it cannot be written.
    """
    rr: Any = required("rerun", "rerun")
    scene = Scene(result)
    with Path(path).open("wb"):
        pass  # says why, where it cannot be written; Rerun's own message names no reason
    recording = rr.RecordingStream("drake_formation")
    recording.save(path)
    recording.send_recording_name(scene.playback.title)
    recording.log(WORLD, rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    _send_bodies(rr, recording, scene)
    times = rr.TimeColumn(TIMELINE, duration=scene.times)
    for name, poses in scene.frames.items():
        x, y, half = *poses[:, :2].T, poses[:, 2] / 2
        nought = np.zeros(len(poses))
        moved = rr.Transform3D.columns(
            translation=np.column_stack([x, y, nought]),
            quaternion=np.column_stack([nought, nought, np.sin(half), np.cos(half)]),
        )
        recording.send_columns(f"{WORLD}/{name}", [times], moved)
    for name, pictures in scene.lines():
        _send_lines(rr, recording, f"{WORLD}/{name}", times, pictures)
    for signal in signals(result):
        samples = rr.TimeColumn(TIMELINE, duration=signal.times)
        for name, values in zip(signal.units, signal.values.T, strict=True):
            recording.send_columns(f"{signal.topic}/{name}", [samples], rr.Scalars.columns(scalars=values))
    recording.disconnect()


def _send_bodies(rr: Any, recording: Any, scene: Scene) -> None:
    """What is fixed to frames, and the paths."""
    for name, frame, pieces in scene.bodies():
        place = f"{WORLD}/{name}" if frame == WORLD else f"{WORLD}/{frame}/{name}"
        for k, piece in enumerate(pieces):
            recording.log(f"{place}/part_{k}", _drawn(rr, piece), static=True)
    for robot, points in scene.paths.items():
        line = rr.LineStrips3D([points], colors=[scene.colours[robot]], radii=THICKNESS / 2)
        recording.log(f"{WORLD}/path_{robot}", line, static=True)


def _drawn(rr: Any, piece: Piece) -> Any:
    """A piece as Rerun draws it."""
    w, x, y, z = piece.turned
    if piece.kind == "triangles":  # whose corners are where they belong
        return rr.Mesh3D(vertex_positions=piece.corners + np.array(piece.place), albedo_factor=piece.colour)
    place = {"centers": [piece.place], "quaternions": [(x, y, z, w)], "colors": [piece.colour], "fill_mode": "solid"}
    if piece.kind == "cylinders":
        return rr.Cylinders3D(radii=[piece.size[0] / 2], lengths=[piece.size[2]], **place)
    if piece.kind == "spheres":
        return rr.Ellipsoids3D(half_sizes=[np.array(piece.size) / 2], **place)
    return rr.Boxes3D(sizes=[piece.size], **place)


def _send_lines(rr: Any, recording: Any, place: str, times: Any, pictures: list[Lines]) -> None:
    counts = [len(lines.ends) for lines in pictures]
    drawn = rr.LineStrips3D.columns(
        strips=np.concatenate([lines.ends for lines in pictures]),
        colors=np.concatenate([lines.colours for lines in pictures]),
        radii=np.full(sum(counts), THICKNESS / 2),
    )
    recording.send_columns(place, [times], drawn.partition(counts))
