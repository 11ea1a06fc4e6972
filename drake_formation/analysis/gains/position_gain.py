"""The smallest consensus gain δ for a requested damping ratio or decay rate, or why there is none."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import Array, LinearFormation
from drake_formation.analysis.linear.motion_subspaces import positions, velocities
from drake_formation.analysis.stability.modes import decay_limit, movable

TRIED = 240
"""Values of δ tried between 0 and where the answer is known to be no."""

LEAST = 1e-9
"""The least damping ratio, and decay rate (1/s), that may be asked for: less cannot be told from none."""

NINE_DIGITS = 1e-9
"""A request is met to nine digits: at δ_v = 0 every relative mode decays at d/2m exactly, to rounding."""


@dataclass(frozen=True)
class SmallestDelta:
    """The smallest δ with which every mode that consensus moves is as requested.

    Attributes:
        damping_ratio: least damping ratio requested, or None.
        decay_rate: least decay rate requested (1/s), or None.
        delta: the smallest δ (N/m); None where no δ does.
        delta_v: δ_v with which it was sought (N s/m), the scenario's.
        reason: what the answer rests on.
        best_delta: where no δ does, the one of those tried that comes nearest (N/m); else the same as ``delta``.
        best_damping_ratio: least damping ratio of these modes there.
        best_decay_rate: least decay rate of these modes there (1/s).
    """

    damping_ratio: float | None
    decay_rate: float | None
    delta: float | None
    delta_v: float
    reason: str
    best_delta: float
    best_damping_ratio: float
    best_decay_rate: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "requested": {"damping_ratio": self.damping_ratio, "decay_rate_1_per_s": self.decay_rate},
            "delta_n_per_m": self.delta,
            "delta_v_n_s_per_m": self.delta_v,
            "reason": self.reason,
            "best": {
                "delta_n_per_m": self.best_delta,
                "damping_ratio": self.best_damping_ratio,
                "decay_rate_1_per_s": self.best_decay_rate,
            },
        }


def smallest_delta(
    formation: LinearFormation, *, damping_ratio: float | None = None, decay_rate: float | None = None
) -> SmallestDelta:
    """Find the smallest δ, at the scenario's δ_v, for which the modes that consensus moves are as requested.

    That a decay rate is out of reach is exact (``modes.decay_limit``), and so is the δ beyond which a damping ratio
    is out of reach: where all modes decay at damping ratios of at least ζ, |tr A²| ≤ (tr A / ζ)², and tr A² falls in
    proportion to δ. In between δ is sought on a fine grid and refined.

    Args:
        formation: its own δ plays no part.
        damping_ratio: least damping ratio, from 1e-9 to 1.
        decay_rate: least decay rate (1/s), 1e-9 or more.

    Raises:
        IllPosedError: nothing sensible is requested, or consensus moves no mode.
    """
    _require_request(damping_ratio, decay_rate)
    space = movable(formation)
    if not space.shape[1]:
        raise IllPosedError("consensus moves no mode of this formation: it takes at least two robots that talk")
    search = _Search(formation, space, damping_ratio, decay_rate)
    tried = search.grid()
    shortfalls = [search.shortfall(delta) for delta in tried]
    first = next((k for k, shortfall in enumerate(shortfalls) if shortfall <= 0), None)
    if first is None:
        return search.answer(None, tried[int(np.argmin(shortfalls))], _refusal(formation, search, tried[-1]))
    if first == 0:
        return search.answer(0.0, 0.0, "δ = 0 does already")
    from scipy.optimize import brentq

    delta = float(brentq(search.shortfall, tried[first - 1], tried[first], xtol=1e-12, rtol=1e-12))
    return search.answer(delta, delta, f"the first of {TRIED} values of δ that does, refined")


def _require_request(damping_ratio: float | None, decay_rate: float | None) -> None:
    if damping_ratio is None and decay_rate is None:
        raise IllPosedError("nothing is requested: give a damping ratio, a decay rate (1/s) or both")
    if damping_ratio is not None and not LEAST <= damping_ratio <= 1:
        raise IllPosedError(f"a damping ratio of {damping_ratio:g} is no request: allowed is from {LEAST:g} to 1")
    if decay_rate is not None and not LEAST <= decay_rate < np.inf:
        raise IllPosedError(f"a decay rate of {decay_rate:g} 1/s is no request: allowed is from {LEAST:g} on")


@dataclass(frozen=True)
class _Search:
    formation: LinearFormation
    space: Array
    damping_ratio: float | None
    decay_rate: float | None

    def loop(self, delta: float) -> Array:
        """The part of the loop that consensus moves."""
        result: Array = self.space.T @ self.formation.closed_loop(delta, self.formation.delta_v) @ self.space
        return result

    def worst(self, delta: float) -> tuple[float, float]:
        """Least damping ratio and least decay rate (1/s)."""
        values = np.linalg.eigvals(self.loop(delta))
        return float((-values.real / np.abs(values)).min()), float(-values.real.max())

    def shortfall(self, delta: float) -> float:
        """By what share the worst mode misses the request; 0 or less where it meets it."""
        damping, decay = self.worst(delta)
        wanted = [(self.damping_ratio, damping), (self.decay_rate, decay)]
        return max(1 - value / request for request, value in wanted if request is not None) - NINE_DIGITS

    def grid(self) -> Array:
        """Values of δ: 0, and from next to nothing to where the answer is known."""
        return np.concatenate([[0.0], self.limit() * np.logspace(-9, 0, TRIED - 1)])

    def limit(self) -> float:
        """A δ beyond which the damping ratio is out of reach or, for a decay rate, all has long been springs (N/m)."""
        at_rest, robots = self.loop(0.0), self.formation.robots
        per_delta = self.space.T @ self.formation.per_delta @ self.space
        falls = -2 * float(np.trace(at_rest @ per_delta))
        if self.damping_ratio is not None:
            # A damping ratio below what rounding leaves is as good as that.
            total = (np.trace(at_rest) / max(self.damping_ratio, NINE_DIGITS)) ** 2
            return float((total + abs(np.trace(at_rest @ at_rest))) / falls)
        block = self.formation.per_delta[np.ix_(velocities(robots), positions(robots))]
        stiffening = -np.linalg.eigvals(block).real
        slowest = stiffening[stiffening > NINE_DIGITS * stiffening.max()].min()
        return float(1e3 * np.abs(np.linalg.eigvals(at_rest)).max() ** 2 / slowest)

    def answer(self, delta: float | None, best: float, reason: str) -> SmallestDelta:
        damping, decay = self.worst(best)
        return SmallestDelta(
            damping_ratio=self.damping_ratio,
            decay_rate=self.decay_rate,
            delta=delta,
            delta_v=self.formation.delta_v,
            reason=reason,
            best_delta=float(best),
            best_damping_ratio=damping,
            best_decay_rate=decay,
        )


def _refusal(formation: LinearFormation, search: _Search, last: float) -> str:
    """Why no δ does, and what would."""
    limit = decay_limit(formation)
    if search.decay_rate is not None and limit is not None and search.decay_rate > limit * (1 + NINE_DIGITS):
        return (
            f"no δ does: at δ_v = {formation.delta_v:g} N s/m these modes decay at {limit:.6g} 1/s on average for "
            "every δ (d/2m for identical robots without damping between them); a larger consensus.delta_v raises it"
        )
    beyond = "none beyond can" if search.damping_ratio is not None else "beyond, δ only adds stiffness"
    return (
        f"no δ does: none of {TRIED} values from 0 to {last:.4g} N/m, and {beyond}; δ is stiffness without damping, so "
        "raise consensus.delta_v or the local damping (tracking.Q)"
    )
