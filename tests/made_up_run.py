"""A result that no simulation has made: robots that gather, ring and pass an obstacle, by formulas."""

import numpy as np
import xarray as xr

from drake_formation.simulation.events import Event, labelled_events

HAND_OFF = 10.0


def made_up_run(robots=8, *, stiff=True, gathering_force=1.8e5):
    """A result of robots on a circle, which gather with great force; if stiff, they ring faster than pixels follow."""
    time = np.linspace(0.0, 40.0, 8001)
    carried = time >= HAND_OFF
    since = np.maximum(time - HAND_OFF, 0.0)
    angles = 2 * np.pi * np.arange(robots) / robots
    slots = np.column_stack([np.cos(angles), np.sin(angles)])
    share = np.exp(-since / 5.0)
    ringing = np.cos((200.0 if stiff else 1.0) * since[:, None] + np.arange(robots)) * share[:, None]
    position = slots * np.where(carried, 1.0, 3.0 - 2.0 * time / HAND_OFF)[:, None, None]
    position = position + np.stack([2.0 + 20.0 * (1 - share), np.sin(since / 3.0)], axis=-1)[:, None]
    pulse = np.exp(-((since - 12.0) ** 2)) * carried
    size = np.where(carried, 1.0, 0.0)[:, None] * (0.02 + 0.002 * np.arange(robots)) * np.abs(ringing)

    def vectors(lengths):
        return ("time", "robot", "axis"), np.stack([lengths, np.zeros_like(lengths)], axis=-1)

    gathering = np.where(carried, 0.0, gathering_force * np.abs(np.sin(300.0 * time)))[:, None]
    tracking, consensus = 30.0 * share[:, None] * np.ones(robots), 1000.0 * size
    avoidance = 6.0 * pulse[:, None] * (np.arange(robots) == 0)
    pairs = [f"{i}-{i + 1}" for i in range(1, robots)]
    happened = [Event("hand_off", HAND_OFF, (2.0, 0.0), (1,), "the object is handed over")]
    variables, coordinates = labelled_events(happened)
    return xr.Dataset(
        {
            "position": (("time", "robot", "axis"), position),
            "deviation": vectors(np.where(carried[:, None], size, np.nan)),
            "consensus_error": vectors(size),
            "control_force": vectors(gathering + tracking + consensus),
            "tracking_force": vectors(tracking),
            "consensus_force": vectors(gathering + consensus),
            "avoidance_force": vectors(avoidance),
            "spring_length": (("time", "spring"), 1.0 + 0.01 * ringing[:, 1:]),
            "rest_length": (("spring",), np.ones(robots - 1)),
            "phase": (("time",), carried.astype(np.int8)),
            "obstacle_position": (("obstacle", "axis"), np.array([[10.0, 3.0]])),
            "obstacle_radius": (("obstacle",), np.array([0.3])),
            **variables,
        },
        {
            "time": time,
            "robot": np.arange(1, robots + 1),
            "axis": ["x", "y"],
            "spring": pairs,
            "obstacle": [1],
            **coordinates,
        },
        {"title": "made up", "sensing_range_m": 1.3, "hand_off_time_s": HAND_OFF},
    )
