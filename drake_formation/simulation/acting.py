"""Which springs or grips hold their robots, and when."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.parts.objects.breaking import breaks

Array = NDArray[np.float64]


def may_let_go(formation: Formation) -> bool:
    """Whether springs or grips may break, or robots drop their load."""
    return breaks(formation) or "held" in formation.signals


def acting(formation: Formation, broken_at: Array | None, times: Array) -> NDArray[np.bool_]:
    """Whether each spring, or each grip where the object is a body of its own, holds its robots.

    Args:
        formation: what ran.
        broken_at: when each broke (s), NaN for never, shape (springs,); None where none may.
        times: when (s), of any shape; one that breaks then still acts.

    Returns:
        Of that shape and (springs,).
    """
    count = formation.robots if formation.has_body else len(formation.springs.pairs)
    acts = np.ones((*np.shape(times), count), dtype=bool)
    if broken_at is not None:
        acts &= ~(np.asarray(times)[..., None] > broken_at)
    held = formation.signals.get("held" if formation.has_body else "whole")
    if held is not None:
        begins = [stage.time for stage in formation.stages]
        acts &= held[np.searchsorted(begins, times, "right") - 1] == 1
    return acts
