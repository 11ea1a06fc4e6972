"""The labelled result of a run: time × robot × axis, units as attributes."""

from importlib.metadata import version

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from drake_formation.formation import graphs
from drake_formation.parameters import obstacle_table
from drake_formation.scenario import Scenario, derive, to_yaml
from drake_formation.simulation.recorder import Recording
from drake_formation.systems.consensus_error import consensus_errors

Array = NDArray[np.float64]

VECTOR = ("time", "robot", "axis")


def labelled_result(scenario: Scenario, run: Recording, nominal: Recording | None) -> xr.Dataset:
    """Label what was recorded.

    Args:
        scenario: the scenario that ran.
        run: what was recorded, at least one sample.
        nominal: the obstacle-free response from the same hand-off state; the run itself where no obstacle is felt;
            None where the run never got there.

    Returns:
        A dataset over ``time`` (every step of the integrator), ``robot`` (from 1), ``axis`` (x, y), ``spring``
        (``1-2``) and ``obstacle`` (from 1). ``deviation`` is NaN before the hand-off.
    """
    state = run.series("state")
    position, velocity = state[..., :2], state[..., 2:]
    slots = derive.slots(scenario)
    springs = graphs.edges(derive.spring_graph(scenario))
    obstacles = obstacle_table(scenario)
    first, second = [i for i, _ in springs], [j for _, j in springs]
    vectors = {
        "position": (position, "m", "position q in the world frame"),
        "velocity": (velocity, "m/s", "velocity v in the world frame"),
        "tracking_error": (run.series("tracking_error")[..., :2], "m", "distance to the reference, q - q_r (Eq. 9)"),
        "deviation": (
            _deviation(run, nominal, derive.hand_off_time(scenario)),
            "m",
            "deviation from the obstacle-free response",
        ),
        "consensus_error": (consensus_errors(position, slots), "m", "consensus error e (Eq. 19)"),
        "tracking_force": (run.series("tracking_force"), "N", "local control u_l (Eq. 10)"),
        "consensus_force": (run.series("consensus_force"), "N", "global control u_g (Eq. 15)"),
        "avoidance_force": (run.series("avoidance_force"), "N", "obstacle avoidance"),
    }
    forces = [vectors[name][0] for name in ("tracking_force", "consensus_force", "avoidance_force")]
    vectors["control_force"] = (np.sum(forces, axis=0), "N", "control u, the sum of the three (Eq. 8)")
    with np.errstate(over="ignore"):  # a run that diverged may end in numbers whose squares overflow
        lengths = np.linalg.norm(position[:, first] - position[:, second], axis=-1)
        clearance = np.linalg.norm(position[:, :, None] - obstacles[:, :2], axis=-1) - obstacles[:, 2]
    variables = {name: _variable(VECTOR, *content) for name, content in vectors.items()}
    variables |= {
        "spring_length": _variable(("time", "spring"), lengths, "m", "length d of a spring"),
        "rest_length": _variable(
            ("spring",), np.linalg.norm(slots[first] - slots[second], axis=-1), "m", "length r of a spring at rest"
        ),
        "clearance": _variable(("time", "robot", "obstacle"), clearance, "m", "distance to an obstacle"),
        "phase": _variable(("time",), run.phases.astype(np.int8), "1", "0 aggregation, 1 transport"),
        "slot": _variable(("robot", "axis"), slots, "m", "slot h relative to the formation centre"),
        "goal": _variable(("axis",), np.array(scenario.transport.goal), "m", "formation centre to reach"),
        "aggregation_centre": _variable(
            ("axis",), derive.aggregation_centre(scenario), "m", "formation centre to gather about"
        ),
        "obstacle_position": _variable(("obstacle", "axis"), obstacles[:, :2], "m", "centre of an obstacle"),
        "obstacle_radius": _variable(("obstacle",), obstacles[:, 2], "m", "radius of an obstacle"),
    }
    coordinates = {
        "time": ("time", run.times, {"units": "s", "long_name": "time"}),
        "robot": np.arange(1, len(slots) + 1),
        "axis": ["x", "y"],
        "spring": [f"{i + 1}-{j + 1}" for i, j in springs],
        "obstacle": np.arange(1, len(obstacles) + 1),
    }
    attributes = {
        "title": scenario.name,
        "scenario": to_yaml(scenario),
        "sensing_range_m": scenario.avoidance.range,
        "hand_off_time_s": derive.hand_off_time(scenario),
        "drake_formation_version": version("drake-formation"),
        "drake_version": version("drake"),
    }
    return xr.Dataset(variables, coordinates, attributes)


def _variable(dimensions: tuple[str, ...], values: Array, units: str, name: str) -> xr.Variable:
    return xr.Variable(dimensions, values, {"units": units, "long_name": name})


def _deviation(run: Recording, nominal: Recording | None, hand_off: float) -> Array:
    """Position relative to the obstacle-free response at the run's own times (m), NaN where there is none."""
    from scipy.interpolate import CubicHermiteSpline  # slow to import, and not needed to build a diagram

    state = run.series("state")
    deviation = np.full_like(state[..., :2], np.nan)
    if nominal is None or len(nominal.times) < 2:
        return deviation
    free = nominal.series("state")
    response = CubicHermiteSpline(nominal.times, free[..., :2], free[..., 2:])
    known = (run.times >= hand_off) & (run.times <= nominal.times[-1])
    deviation[known] = state[known][..., :2] - response(run.times[known])
    return deviation
