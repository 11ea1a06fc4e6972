"""Why a loop is unstable, and changes to the scenario that make it stable, each one tried out.

Every local LQR is stable by itself, but its gain need not be symmetric: with Q or R that couple x and y, K_l may feed
energy into a direction that springs or consensus leave over. Where Q and R are diagonal, so is K_l, the loop reads
M q̈ + D q̇ + K q = 0 with symmetric positive definite M, D and K, and it is stable whatever δ, δ_v and the object are.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from drake_formation.analysis.linear.assumptions import same_lqr
from drake_formation.analysis.linear.linearization import Array, LinearFormation, linearize
from drake_formation.scenario import ScenarioError, with_overrides

TRIED = 10.0 ** np.arange(0.0, 6.01, 0.25)
"""Values of δ_v that are tried (N s/m)."""


@dataclass(frozen=True)
class Remedy:
    """A change that makes the loop stable.

    Attributes:
        overrides: for ``--set`` or ``with_overrides``.
        decay_rate: what the slowest mode then decays at (1/s).
    """

    overrides: dict[str, Any]
    decay_rate: float

    def __str__(self) -> str:
        """As it is typed, and what it gives."""
        compact = {path: json.dumps(value, separators=(",", ":")) for path, value in self.overrides.items()}
        typed = " ".join(f"--set {path}={value}" for path, value in compact.items())
        return f"{typed} (then the slowest mode decays at {self.decay_rate:.3g} 1/s)"

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {"overrides": self.overrides, "decay_rate_1_per_s": self.decay_rate}


def cause(formation: LinearFormation) -> str:
    """Which parts of the loop it takes to lose stability, in a sentence."""
    without = {
        "the object's springs": formation.tracking + formation.consensus(formation.delta, formation.delta_v),
        "consensus": formation.tracking + formation.springs,
    }
    needed = [part for part, loop in without.items() if _decay(loop) > 0]
    if not needed:
        return "the local loops alone are stable; either springs or consensus is enough to destabilize them"
    return f"the local loops alone are stable; it takes {' together with '.join(needed)} to destabilize them"


def remedies(formation: LinearFormation) -> tuple[Remedy, ...]:
    """Changes to an unstable scenario after which it is stable, of those that were tried."""
    return tuple(_tried(formation))


def _tried(formation: LinearFormation) -> Iterator[Remedy]:
    lqr = same_lqr(formation.resolved)
    q, r = lqr.state_cost, lqr.input_cost
    diagonal = {"tracking.Q": np.diag(q).tolist(), "tracking.R": np.diag(r).tolist()}
    try:
        decay = _decay(linearize(with_overrides(formation.scenario, diagonal)).A)
    except ScenarioError:
        decay = 0.0  # a diagonal alone may leave something out of the cost
    if decay > 0:
        yield Remedy(diagonal, decay)
    for delta_v in TRIED[formation.delta_v < TRIED]:
        decay = _decay(formation.closed_loop(formation.delta, float(delta_v)))
        if decay > 0:
            yield Remedy({"consensus.delta_v": float(f"{delta_v:.3g}")}, decay)
            return


def _decay(loop: Array) -> float:
    """Decay rate of the slowest mode, or 0 for one that rounding cannot tell from undamped."""
    values = np.linalg.eigvals(loop)
    slowest = float(-values.real.max())
    return slowest if slowest > 1e-12 * float(np.abs(values).max()) else 0.0
