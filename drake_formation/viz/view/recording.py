"""The viewing diagram of a result, and the result recorded through it."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from pydrake.geometry import (
    FrameId,
    GeometryFrame,
    GeometryInstance,
    MakePhongIllustrationProperties,
    Meshcat,
    MeshcatVisualizer,
    MeshcatVisualizerParams,
    SceneGraph,
    SourceId,
)
from pydrake.math import RigidTransform
from pydrake.systems.framework import Diagram, DiagramBuilder

from drake_formation.viz.figures import robot_colours
from drake_formation.viz.links import Link, largest_strain, moving_links
from drake_formation.viz.playback import Playback
from drake_formation.viz.view.carried import object_solids
from drake_formation.viz.view.flights import Flights
from drake_formation.viz.view.frames import key_times
from drake_formation.viz.view.link_drawer import LinkDrawer
from drake_formation.viz.view.marks import Marks
from drake_formation.viz.view.obstacles import obstacle_solids
from drake_formation.viz.view.poses import PoseSource
from drake_formation.viz.view.robots import solids_of
from drake_formation.viz.view.solids import Colour, Solid
from drake_formation.viz.view.stage import bounds, goal, look_at, set_stage
from drake_formation.viz.view.trails import Trails

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

ROOT = "/formation"
BODIES = f"{ROOT}/bodies"

MOMENTS = 1024.0
"""Of a recording, a second: what happens between pictures, such as a packet's flight, is as exact as that."""

FEWEST, MOST, DRAWN = 300, 1200, 25_000
"""Pictures that a recording may have: so many that pictures by things that move are ``DRAWN``, between the others."""


def record(result: "xr.Dataset", meshcat: Meshcat, *, follow: bool = False) -> Playback:
    """Record a result in Meshcat, whose browser then plays, pauses, scrubs and changes the speed.

    The time in the browser counts from the begin of the result. What an earlier result has left there is removed.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
        meshcat: where.
        follow: keep the formation in the middle of the picture, where the ground goes by; otherwise all of the ground
            is seen.

    Returns:
        What is played.

    Raises:
        ValueError, ScenarioError: as for :class:`Playback`.
    """
    playback = Playback(result)
    meshcat.DeleteRecording()
    meshcat.Delete(ROOT)
    links = moving_links(playback)
    most = int(np.clip(DRAWN / (len(links) + playback.formation.robots), FEWEST, MOST))
    times = key_times(playback, links, most)
    colours: dict[int, Colour] = {robot: (r, g, b, 1.0) for robot, (r, g, b, *_) in robot_colours(result).items()}
    places = playback.positions(np.minimum(playback.begin + times, playback.end))
    centres = places.mean(axis=1) if follow else np.zeros((len(times), 2))
    low, high = bounds(playback, places)
    set_stage(meshcat, f"{ROOT}/ground", low, high)
    look_at(meshcat, *(_surroundings(playback) if follow else (low, high)))
    trails = Trails(meshcat, f"{ROOT}/trails", playback, colours)
    flights = Flights(meshcat, f"{ROOT}/packets", playback)
    diagram = viewing_diagram(playback, meshcat, links, colours)
    context = diagram.CreateDefaultContext()
    marks = Marks(meshcat, BODIES, f"{ROOT}/events", playback)
    meshcat.StartRecording(MOMENTS, set_visualizations_while_recording=False)
    for time, centre in zip(times, centres, strict=True):
        context.SetTime(time)
        diagram.ForcedPublish(context)
        meshcat.SetTransform(ROOT, RigidTransform([*-centre, 0.0]), time)
    for coming_and_going in (trails, flights, marks):
        coming_and_going.record()
    meshcat.StopRecording()
    meshcat.PublishRecording()
    return playback


def _surroundings(playback: Playback) -> tuple[Array, Array]:
    """Corners of what is seen about the formation, where that is in the middle (m)."""
    reach = 1.5 * playback.formation.radius + 1.0
    return np.array([-reach, -reach]), np.array([reach, reach])


def viewing_diagram(playback: Playback, meshcat: Meshcat, links: list[Link], colours: dict[int, Colour]) -> Diagram:
    """A diagram without dynamics: a source of poses, SceneGraph, and what draws in Meshcat.

    Args:
        playback: what the source plays.
        meshcat: where to draw.
        links: what is stretched between the robots and the object's nodes.
        colours: of the robots, by number from 1.
    """
    builder = DiagramBuilder()
    scene = builder.AddNamedSystem("scene_graph", SceneGraph())
    source = scene.RegisterSource("result")
    robots = []
    for i, (robot, colour) in enumerate(colours.items()):
        frame = scene.RegisterFrame(source, GeometryFrame(f"robot_{robot}"))
        _register(scene, source, frame, solids_of(playback.formation, i), colour)
        _stand(scene, source, f"goal_{robot}", goal(playback, i), (*colour[:3], 0.5))
        robots.append(frame)
    body = None
    if playback.formation.has_body and not playback.nodes:
        body = scene.RegisterFrame(source, GeometryFrame("object"))
        _register(scene, source, body, object_solids(playback.formation))
    moving = {}
    for k, obstacle in enumerate(playback.formation.obstacles):
        frame = scene.world_frame_id()
        if len(obstacle.motion):
            frame = moving[k] = scene.RegisterFrame(source, GeometryFrame(f"obstacle_{k + 1}"))
        solids = obstacle_solids(obstacle, playback.sensing_range)
        _register(scene, source, frame, solids, name=f"obstacle_{k + 1}")

    poses = builder.AddNamedSystem("poses", PoseSource(playback, robots, body, moving, links))
    builder.Connect(poses.GetOutputPort("poses"), scene.get_source_pose_port(source))
    MeshcatVisualizer.AddToBuilder(builder, scene, meshcat, MeshcatVisualizerParams(prefix=BODIES))
    count = playback.formation.robots + playback.nodes
    drawer = LinkDrawer(meshcat, ROOT, links, count, largest_strain(playback, links))
    builder.AddNamedSystem("links", drawer)
    for name in ("points", "shown", "alive"):
        builder.Connect(poses.GetOutputPort(name), drawer.GetInputPort(name))
    return builder.Build()


def _register(
    scene: SceneGraph,
    source: SourceId,
    frame: FrameId,
    solids: Iterable[Solid],
    colour: Colour = (0, 0, 0, 1),
    name: str = "part",
) -> None:
    """Fix solids to a frame; those without a colour have the given one."""
    for k, solid in enumerate(solids):
        scene.RegisterGeometry(source, frame, _instance(f"{name}_{k}", solid, colour))


def _stand(scene: SceneGraph, source: SourceId, name: str, solid: Solid, colour: Colour = (0, 0, 0, 1)) -> None:
    """Fix a solid to the world."""
    scene.RegisterAnchoredGeometry(source, _instance(name, solid, colour))


def _instance(name: str, solid: Solid, colour: Colour) -> GeometryInstance:
    instance = GeometryInstance(solid.pose, solid.shape, name)
    instance.set_illustration_properties(MakePhongIllustrationProperties(list(solid.colour or colour)))
    return instance
