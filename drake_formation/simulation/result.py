"""The labelled result of a run: time × robot × axis, units as attributes."""

from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np

from drake_formation.parts.roles import TRAFFIC
from drake_formation.scenario import resolve, to_yaml
from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate
from drake_formation.simulation.choice import Choice
from drake_formation.simulation.events import labelled_events
from drake_formation.simulation.happened import found_events
from drake_formation.simulation.obstacles import chattering
from drake_formation.simulation.series import Series

if TYPE_CHECKING:
    import xarray as xr

VECTOR = ("time", "robot", "axis")
VARIABLES = {
    "position": (VECTOR, "m", "position q in the world frame"),
    "velocity": (VECTOR, "m/s", "velocity v in the world frame"),
    "acceleration": (VECTOR, "m/s²", "acceleration in the world frame"),
    "tracking_error": (VECTOR, "m", "distance to the reference, q - q_r (Eq. 9)"),
    "deviation": (VECTOR, "m", "deviation from the obstacle-free response"),
    "deviation_velocity": (VECTOR, "m/s", "rate of the deviation"),
    "deviation_acceleration": (VECTOR, "m/s²", "second rate of the deviation"),
    "consensus_error": (VECTOR, "m", "consensus error e (Eq. 19)"),
    "tracking_force": (VECTOR, "N", "local control u_l (Eq. 10)"),
    "consensus_force": (VECTOR, "N", "global control u_g (Eq. 15)"),
    "avoidance_force": (VECTOR, "N", "obstacle avoidance"),
    "control_force": (VECTOR, "N", "control u that acts on a robot, the sum of the three (Eq. 8) unless limited"),
    "spring_force": (VECTOR, "N", "what the object exerts on a robot"),
    "spring_length": (("time", "spring"), "m", "length d of a spring"),
    "rest_length": (("spring",), "m", "length r of a spring at rest"),
    "clearance": (("time", "robot", "obstacle"), "m", "distance to an obstacle, from the robot's footprint"),
    "phase": (("time",), "1", "0 aggregation, 1 transport"),
    "slot": (("robot", "axis"), "m", "slot h relative to the formation centre"),
    "goal": (("axis",), "m", "formation centre to reach"),
    "aggregation_centre": (("axis",), "m", "formation centre to gather about"),
    "obstacle_position": (("obstacle", "axis"), "m", "middle of an obstacle before it moves"),
    "obstacle_radius": (("obstacle",), "m", "radius of an obstacle"),
}
"""Dimensions, unit and meaning of each variable."""

POSE = ("x", "y", "heading", "x_rate", "y_rate", "heading_rate")
SOMETIMES = {
    "demanded_force": (VECTOR, "N", "control asked of a robot's actuators, which exert control_force"),
    "measured_position": (VECTOR, "m", "position that a robot takes for its own"),
    "measured_velocity": (VECTOR, "m/s", "velocity that a robot takes for its own"),
    "object_pose": (("time", "pose"), "m, m, rad, m/s, m/s, rad/s", "place and heading of the object and their rates"),
    "object_strain": (("time",), "1", "strain of the object"),
    "object_nodes": (("time", "node", "axis"), "m", "places of the nodes of the object, row by row"),
    "heading": (("time", "robot"), "rad", "heading of a robot's body, from +x counter-clockwise"),
    "traffic": (("time", "channel", "count"), "1, and s", "packets so far, and when the one in use was sent"),
    "obstacle_outline": (("time", "obstacle", "vertex", "axis"), "m", "vertices of an obstacle"),
    "robot_radius": (("robot",), "m", "radius of a robot's footprint"),
}
"""Those there are where the computer or actuators of a robot, or its sensors, are no wires, where the object is a
body of its own or a grid, where robots have headings, where channels carry packets, where obstacles are no circles or
move, and where robots have footprints."""

FAILING_VARIABLES = {
    "driven": (("time", "robot"), "1", "1 while the drives of a robot work, else 0"),
    "acting": (("time", "spring"), "1", "1 while a spring holds its robots, else 0"),
    "grip_acting": (("time", "robot"), "1", "1 while the grip of a robot holds, else 0"),
    "broken_at": (("spring",), "s", "when a spring broke"),
    "grip_broken_at": (("robot",), "s", "when the grip of a robot broke"),
}
"""Those there may be where something fails or breaks; NaN stands for never."""


def labelled_result(series: Series) -> "xr.Dataset":
    """Label what came out of a run.

    Args:
        series: from :func:`drake_formation.simulation.series.time_series`.

    Returns:
        A dataset over ``time`` (every step of the integrator), ``robot`` (from 1), ``axis`` (x, y), ``spring``
        (``1-2``) and ``obstacle`` (from 1). ``control_force`` is what acts on the robots; where the computer or the
        actuators of any are no wires, ``demanded_force`` is what is asked of the actuators. Where sensors are none,
        ``measured_position`` and ``measured_velocity`` are what robots take for their own and send; all else is true.
        An object that is a body of its own has ``object_pose`` over ``pose``, ``object_strain``, as its kind says, and
        ``object_nodes`` over ``node`` if it is a grid. ``heading`` is there if any robot has one, and NaN for those
        that have none. Obstacles that are no circles or move have ``obstacle_outline`` over ``vertex``.
        Channels that carry packets to a robot that listens have ``traffic`` over ``channel`` (what robot 2 tells robot
        1 is ``2-1``) and ``count``.
        ``deviation`` is NaN before the hand-off. A sample at the hand-off shows what is so from then on. Between
        samples the motion is the quintic with position, velocity and acceleration at both ends;
        :func:`drake_formation.measuring.metrics` measures that. The attribute ``remark`` says what to know about the
        run, if there is anything. What happened at one moment is in ``event_place``; see
        :func:`drake_formation.simulation.events.events`.
    """
    import xarray as xr  # slow to import, and not needed to build a diagram

    import drake_formation.results  # noqa: F401 (gives the result its ``formation``)

    variables = {
        name: xr.Variable(dimensions, series[name], {"units": units, "long_name": meaning})
        for name, (dimensions, units, meaning) in (VARIABLES | SOMETIMES | FAILING_VARIABLES).items()
        if name in VARIABLES or name in series
    }
    variables["phase"] = variables["phase"].astype(np.int8)
    scenario = series.scenario
    formation = resolve(scenario)
    coordinates = {
        "time": ("time", series["time"], {"units": "s", "long_name": "time"}),
        "robot": np.arange(1, len(series["slot"]) + 1),
        "axis": ["x", "y"],
        "spring": [f"{i + 1}-{j + 1}" for i, j in formation.springs.pairs.tolist()],
        "obstacle": np.arange(1, len(series["obstacle_radius"]) + 1),
    }
    if "object_pose" in series:
        coordinates["pose"] = list(POSE)
    if "object_nodes" in series:
        coordinates["node"] = np.arange(1, series["object_nodes"].shape[1] + 1)
    happened, when = labelled_events(found_events(series))
    if "traffic" in series:
        coordinates["channel"] = series["channel"]
        coordinates["count"] = list(TRAFFIC)
    attributes = {
        "title": scenario.name,
        "scenario": to_yaml(scenario),
        "sensing_range_m": float(formation.sensing_ranges.max()),
        "hand_off_time_s": formation.hand_off,
        "engine": series.choice.engine,
        "drake_formation_version": version("drake-formation"),
        "drake_version": version("drake"),
    }
    if series.choice.reason:
        attributes["engine_reason"] = series.choice.reason
    if remark := chattering(scenario, series["clearance"][series["phase"] == 1]):
        attributes["remark"] = remark
    return xr.Dataset(variables | happened, coordinates | when, attributes)


def series_of(result: "xr.Dataset") -> Series:
    """The variables of a labelled result, as they were before they were labelled.

    Args:
        result: from :func:`labelled_result`, or read from ``result.nc``.

    Raises:
        ValueError: it is no such result, or one of an earlier version, which recorded less.
        ScenarioError: its scenario is not one of this version.
    """
    missing = [
        *(name for name in VARIABLES if name not in result),
        *(name for name in ("scenario", "engine") if name not in result.attrs),
    ]
    if missing:
        raise ValueError(f"not a result of this version: it has no {', '.join(missing)}")
    scenario = validate(parse(result.attrs["scenario"], "the result's scenario"))
    arrays = {str(name): variable.values for name, variable in result.variables.items()}
    return Series(arrays, scenario, Choice(result.attrs["engine"], result.attrs.get("engine_reason", "")))
