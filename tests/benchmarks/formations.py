"""What the benchmarks run."""

from drake_formation import Scenario

STIFF = {"springs.stiffness": 3e4, "consensus.delta": 2e4}
IN_FORMATION = {"aggregation.duration": 0.0, "robots.start": {"centre": [2.5, 3.5]}}


def polygon(robots):
    """Robots in formation, everything coupled with everything."""
    return Scenario.model_validate(
        {
            "name": f"polygon-{robots}",
            "formation": {"shape": "polygon", "robots": robots, "side": 1.0},
            "robots": {"start": {"centre": [0.0, 0.0]}},
            "springs": {"stiffness": 1000.0, "damping": 1.0},
            "consensus": {"delta": 100.0, "delta_v": 1.0},
            "avoidance": {"obstacles": [{"position": [60.0, 5.05]}, {"position": [80.0, 1.9]}]},
            "transport": {"goal": [100.0, 0.0]},
        }
    )
