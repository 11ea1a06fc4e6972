"""The labelled result of a run: time × robot × axis, units as attributes."""

from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np

from drake_formation.formation import graphs
from drake_formation.scenario import Scenario, derive, to_yaml
from drake_formation.simulation.obstacles import chattering
from drake_formation.simulation.series import Series

if TYPE_CHECKING:
    import xarray as xr

VECTOR = ("time", "robot", "axis")
VARIABLES = {
    "position": (VECTOR, "m", "position q in the world frame"),
    "velocity": (VECTOR, "m/s", "velocity v in the world frame"),
    "tracking_error": (VECTOR, "m", "distance to the reference, q - q_r (Eq. 9)"),
    "deviation": (VECTOR, "m", "deviation from the obstacle-free response"),
    "consensus_error": (VECTOR, "m", "consensus error e (Eq. 19)"),
    "tracking_force": (VECTOR, "N", "local control u_l (Eq. 10)"),
    "consensus_force": (VECTOR, "N", "global control u_g (Eq. 15)"),
    "avoidance_force": (VECTOR, "N", "obstacle avoidance"),
    "control_force": (VECTOR, "N", "control u, the sum of the three (Eq. 8)"),
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


def labelled_result(scenario: Scenario, series: Series) -> "xr.Dataset":
    """Label what came out of a run.

    Args:
        scenario: the scenario that ran.
        series: from :func:`drake_formation.simulation.series.time_series`.

    Returns:
        A dataset over ``time`` (every step of the integrator), ``robot`` (from 1), ``axis`` (x, y), ``spring``
        (``1-2``) and ``obstacle`` (from 1). ``deviation`` is NaN before the hand-off. The attribute ``remark`` says
        what to know about the run, if there is anything.
    """
    import xarray as xr  # slow to import, and not needed to build a diagram

    variables = {
        name: xr.Variable(dimensions, series[name], {"units": units, "long_name": meaning})
        for name, (dimensions, units, meaning) in VARIABLES.items()
    }
    variables["phase"] = variables["phase"].astype(np.int8)
    springs = graphs.edges(derive.spring_graph(scenario))
    coordinates = {
        "time": ("time", series["time"], {"units": "s", "long_name": "time"}),
        "robot": np.arange(1, len(series["slot"]) + 1),
        "axis": ["x", "y"],
        "spring": [f"{i + 1}-{j + 1}" for i, j in springs],
        "obstacle": np.arange(1, len(series["obstacle_radius"]) + 1),
    }
    attributes = {
        "title": scenario.name,
        "scenario": to_yaml(scenario),
        "sensing_range_m": scenario.avoidance.range,
        "hand_off_time_s": derive.hand_off_time(scenario),
        "drake_formation_version": version("drake-formation"),
        "drake_version": version("drake"),
    }
    if remark := chattering(scenario, series["clearance"][series["phase"] == 1]):
        attributes["remark"] = remark
    return xr.Dataset(variables, coordinates, attributes)
