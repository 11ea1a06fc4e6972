"""The source of the viewing diagram: a block that shows a playback at a Context's time."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from pydrake.common.value import AbstractValue
from pydrake.geometry import FrameId, FramePoseVector
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import Context, LeafSystem

from drake_formation.viz.links import Link, alive, present
from drake_formation.viz.playback import Playback


class PoseSource(LeafSystem):  # type: ignore[misc]
    """Plays a result.

    Output ports: ``poses`` of the frames, for SceneGraph; ``points``, the robots' and the object's nodes (m), and
    ``shown`` and ``alive``, for every link 1 if it is to be seen, and if it is no silent channel, else 0, as
    :class:`drake_formation.viz.view.link_drawer.LinkDrawer` takes them.

    Args:
        playback: what to play.
        robots: frame of every robot.
        body: frame of the object, if that is a rigid body.
        obstacles: frames of those that move, by their numbers from 0.
        links: what is drawn between the points.
    """

    def __init__(
        self,
        playback: Playback,
        robots: Sequence[FrameId],
        body: FrameId | None,
        obstacles: Mapping[int, FrameId],
        links: Sequence[Link],
    ) -> None:
        super().__init__()
        self._playback, self._robots, self._body, self._obstacles = playback, robots, body, obstacles
        self._links = links
        points = playback.formation.robots + playback.nodes
        self.DeclareAbstractOutputPort("poses", lambda: AbstractValue.Make(FramePoseVector()), self._calc_poses)
        self.DeclareVectorOutputPort("points", 2 * points, self._calc_points)
        self.DeclareVectorOutputPort("shown", len(links), self._calc_shown)
        self.DeclareVectorOutputPort("alive", len(links), self._calc_alive)

    def _calc_poses(self, context: Context, output: Any) -> None:
        time = self._now(context)
        (places,), (headings,) = self._playback.positions(time), self._playback.headings(time)
        poses = FramePoseVector()
        for frame, (x, y), heading in zip(self._robots, places, headings, strict=True):
            poses.set_value(frame, _pose(x, y, heading))
        if self._body is not None:
            poses.set_value(self._body, _pose(*self._playback.body(time)[0]))
        (moved,) = self._playback.moved(time)
        for k, frame in self._obstacles.items():
            x, y = moved[k]
            poses.set_value(frame, _pose(x, y, 0.0))
        output.set_value(poses)

    def _calc_points(self, context: Context, output: Any) -> None:
        output.SetFromVector(self._playback.points(self._now(context)).ravel())

    def _calc_shown(self, context: Context, output: Any) -> None:
        output.SetFromVector(present(self._playback, self._links, self._now(context))[0].astype(float))

    def _calc_alive(self, context: Context, output: Any) -> None:
        output.SetFromVector(alive(self._playback, self._links, self._now(context))[0].astype(float))

    def _now(self, context: Context) -> Any:
        """The Context's time, counted from 0, as time in the scenario (s)."""
        return np.array([self._playback.begin + context.get_time()])


def _pose(x: float, y: float, heading: float) -> RigidTransform:
    return RigidTransform(RotationMatrix.MakeZRotation(heading), [x, y, 0.0])
