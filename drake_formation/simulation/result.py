"""The labelled result of a run: time × robot × axis, units as attributes."""

from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np

from drake_formation.scenario import resolve, to_yaml
from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate
from drake_formation.simulation.choice import Choice
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
    "control_force": (VECTOR, "N", "control u, the sum of the three (Eq. 8)"),
    "spring_force": (VECTOR, "N", "what the object exerts on a robot"),
    "spring_length": (("time", "spring"), "m", "length d of a spring"),
    "rest_length": (("spring",), "m", "length r of a spring at rest"),
    "clearance": (("time", "robot", "obstacle"), "m", "distance to an obstacle"),
    "phase": (("time",), "1", "0 aggregation, 1 transport"),
    "slot": (("robot", "axis"), "m", "slot h relative to the formation centre"),
    "goal": (("axis",), "m", "formation centre to reach"),
    "aggregation_centre": (("axis",), "m", "formation centre to gather about"),
    "obstacle_position": (("obstacle", "axis"), "m", "centre of an obstacle"),
    "obstacle_radius": (("obstacle",), "m", "radius of an obstacle"),
}
"""Dimensions, unit and meaning of each variable."""

POSE = ("x", "y", "heading", "x_rate", "y_rate", "heading_rate")
OBJECT_VARIABLES = {
    "object_pose": (("time", "pose"), "m, m, rad, m/s, m/s, rad/s", "place and heading of the object and their rates"),
    "object_strain": (("time",), "1", "strain of the object"),
    "object_nodes": (("time", "node", "axis"), "m", "places of the nodes of the object, row by row"),
}
"""Those there may be where the object is a body of its own."""

ROBOT_VARIABLES = {"heading": (("time", "robot"), "rad", "heading of a robot's body, from +x counter-clockwise")}
"""Those there are where any robot has them."""


def labelled_result(series: Series) -> "xr.Dataset":
    """Label what came out of a run.

    Args:
        series: from :func:`drake_formation.simulation.series.time_series`.

    Returns:
        A dataset over ``time`` (every step of the integrator), ``robot`` (from 1), ``axis`` (x, y), ``spring``
        (``1-2``) and ``obstacle`` (from 1); an object that is a body of its own has ``object_pose`` over ``pose``,
        ``object_strain``, as its kind says, and ``object_nodes`` if it is a grid; ``heading`` is there if any robot has
        one, and NaN for those that have none. ``deviation`` is NaN before the hand-off. A sample at the hand-off shows
        what is so from then on. Between samples the motion is the quintic with position, velocity and acceleration at
        both ends; :func:`drake_formation.measuring.metrics` measures that. The attribute ``remark`` says what to know
        about the run, if there is anything.
    """
    import xarray as xr  # slow to import, and not needed to build a diagram

    variables = {
        name: xr.Variable(dimensions, series[name], {"units": units, "long_name": meaning})
        for name, (dimensions, units, meaning) in (VARIABLES | ROBOT_VARIABLES | OBJECT_VARIABLES).items()
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
    if formation.has_body:
        coordinates["pose"] = list(POSE)
    if "object_nodes" in series:
        coordinates["node"] = np.arange(1, series["object_nodes"].shape[1] + 1)
    attributes = {
        "title": scenario.name,
        "scenario": to_yaml(scenario),
        "sensing_range_m": max(float(getattr(part.config, "range", 0.0)) for part in formation.parts["avoidance"]),
        "hand_off_time_s": formation.hand_off,
        "engine": series.choice.engine,
        "drake_formation_version": version("drake-formation"),
        "drake_version": version("drake"),
    }
    if series.choice.reason:
        attributes["engine_reason"] = series.choice.reason
    if remark := chattering(scenario, series["clearance"][series["phase"] == 1]):
        attributes["remark"] = remark
    return xr.Dataset(variables, coordinates, attributes)


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
