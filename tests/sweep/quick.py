"""Small sweeps, quick to run; as mappings, which tests change to their needs."""

QUICK = {"aggregation.duration": 0.5, "transport.duration": 0.5, "robots.start": {"centre": [2.5, 3.5]}}
"""What makes a shipped scenario short."""


def quick_sweep(*axes, **others):
    """A short sweep over axes; two of numbers, twelve points, if none are given."""
    axes = axes or (
        {"path": "springs.stiffness", "logspace": [1.0, 1e4, 4]},
        {"path": "consensus.delta", "values": [0.0, 10.0, 1e3]},
    )
    return {"name": "quick", "scenario": "line", "set": QUICK, "axes": list(axes), **others}


FAILING = {
    "kind": "list",
    "points": [
        {"label": "sound", "set": {"robots.mass": 40.0}},
        {"label": "three masses for two robots", "set": {"robots.mass": [40.0, 40.0, 40.0]}},
        {"label": "light", "set": {"robots.mass": 10.0}},
        {
            "label": "diverging",
            "set": {
                "consensus.delta": 1e6,
                "simulator.use_error_control": False,
                "simulator.max_step_size": 0.5,
                "robots.start": [[0.0, 0.0], [3.0, 5.0]],
                "transport.duration": 60.0,
            },
        },
    ],
}
"""An axis of four points, of which the second is wrong and the last diverges."""
