"""Results of short runs, made once, for tests of what becomes of results."""

import functools

from drake_formation import load_scenario, simulate

SECONDS = {"aggregation.duration": 1.0, "transport.duration": 2.0}


@functools.cache
def short(name="line", **overrides):
    """A shipped scenario for three seconds, with the hand-off after one."""
    given = {path.replace("__", "."): value for path, value in overrides.items()}
    return simulate(load_scenario(name, overrides=SECONDS | given), engine="blocks")


def lossy():
    """One whose channels carry packets, some of which are lost."""
    return short(consensus__channel__kind="packets", consensus__channel__period=0.1, consensus__channel__loss=0.3)
