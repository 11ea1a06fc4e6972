"""One robot and its local controller, alone; shared by the tests of tracking parts."""

import numpy as np

from drake_formation import load_scenario, simulate

START = np.array([2.0, -1.0])
"""Where the robot starts (m); its reference is the origin."""


def alone(duration=3.0, **tracking):
    """A scenario of one robot that is called to the origin."""
    overrides = {
        "formation": {"shape": "line", "robots": 1, "side": 1.0},
        "robots.start": [START.tolist()],
        "transport": {"goal": [0.0, 0.0], "duration": duration},
        "aggregation.duration": 0.0,
        "avoidance": {"obstacles": []},
        "tracking": tracking,
        "simulator.accuracy": 1e-9,
    }
    return load_scenario("line", overrides=overrides)


def path(engine="compiled", **tracking):
    """Times (s), and positions (m) of shape (times, 2), of that robot."""
    result = simulate(alone(**tracking), engine=engine)
    return result["time"].values, result["position"].values[:, 0]


def two(duration=2.0, **tracking):
    """A scenario of two robots that an object couples."""
    overrides = {
        "robots.start": [[0.0, 0.8], [0.3, -0.4]],
        "transport": {"goal": [3.0, 1.0], "duration": duration},
        "springs.stiffness": 20.0,
        "aggregation.duration": 0.0,
        "avoidance": {"obstacles": []},
        "tracking": tracking,
    }
    return load_scenario("line", overrides=overrides)


def apart(engine, **tracking):
    """How far the engine's final positions are from the blocks' (m)."""
    found, blocks = (simulate(two(**tracking), engine=name)["position"].values[-1] for name in (engine, "blocks"))
    return np.abs(found - blocks).max()
