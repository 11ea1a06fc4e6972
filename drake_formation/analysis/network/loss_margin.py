"""Loss margin: how many packets may the channels lose?

Every directed channel carries one packet a period and loses each independently with probability p. What a robot does
without one decides what a loss is (:data:`~drake_formation.analysis.network.sampled_data.Lost`):

* ``zero``: it leaves the term of that channel out, for the period. On average consensus is weaker by 1 − p, and weaker
  virtual springs need less damping: with δ_v = 0, loss calms the loop. It harms where packets are rare: one that does
  arrive is a blow of δ T per metre (N s/m) as ever, while the mean damping that takes its energy out has become less.
  For two robots and short periods the margin is where δ T = 2 (d + 2 (1 − p) δ_v), d the local LQR's damping (N s/m).
  Rarer still, and the local LQR alone keeps order.
* ``hold``: it goes on with what it received last, p/(1 − p) periods older on average. Loss is then delay. For virtual
  springs without damping there is as much room as the delay margin leaves: on a complete graph of N robots up to
  p/(1 − p) = N (T*/T − 1)/2, with T* the longest stable period; with two robots p = 1 − T/T*.

Stable in mean square means that the covariance of all deviations decays; then almost every single run does. Without
loss that needs a period below the longest stable one, for short periods T* = 2 τ*, with τ* the delay margin of the
whole relative term: 0.9 ms for the paper's line at δ = 1e4 N/m, 0.23 ms for its octagon. With δ_v for a damping ratio
of 0.7 it is 64 ms and 32 ms.

A margin takes some forty mean-square gains, each of which costs the cube of the states: 4N with ``zero``, seconds for
thirty robots; 4N + 2 for every channel with ``hold``, seconds up to a hundred channels.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.network.intervals import Interval, where_negative
from drake_formation.analysis.network.mean_square import mean_square_gain
from drake_formation.analysis.network.sampled_data import Lost, SampledLoop, longest_period, sampled_loop

Array = NDArray[np.float64]

PERIOD = 0.01
"""Sampling period (s) where none is given; chosen: a hundred packets a second from every robot."""

HIGHEST = 0.999
"""Loss probability up to which stability is looked at: beyond it next to nothing is communicated."""

TRIED = 33
"""Loss probabilities tried, evenly in the logarithm of the odds p/(1 − p)."""

NO_LOSS = -36.0
"""That logarithm where no packet is lost, to rounding."""


@dataclass(frozen=True)
class LossMargin:
    """The loss probability up to which the sampled formation is stable in mean square.

    Attributes:
        probability: p̄: stable for 0 ≤ p < p̄; None: for every p up to ``HIGHEST``.
        period_s: sampling period T (s).
        lost: what stands in for a lost packet.
        longest_period_s: the longest sampling period that the loop tolerates without loss (s), None if above
            :func:`~drake_formation.analysis.network.sampled_data.longest_period`'s horizon.
    """

    probability: float | None
    period_s: float
    lost: Lost
    longest_period_s: float | None

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in their keys."""
        return {
            "probability": self.probability,
            "period_s": self.period_s,
            "lost": self.lost,
            "longest_period_s": self.longest_period_s,
        }

    def meaning(self) -> str:
        """What the number says, in a sentence."""
        without = "leave its term out" if self.lost == "zero" else "go on with the one before"
        packets = f"packets every {1e3 * self.period_s:.3g} ms, of which robots that miss one {without}"
        if self.probability is None:
            return f"{packets}, may be lost at any rate up to {HIGHEST:.1%}: the formation stays stable in mean square"
        return f"{packets}, may be lost with a probability below {self.probability:.3g}"


def loss_margin(formation: LinearFormation, *, period_s: float = PERIOD, lost: Lost = "zero") -> LossMargin:
    """The loss margin: the first loss probability at which ρ(E[Φ ⊗ Φ]) = 1.

    Stability need not be monotone in p: at p = 1 nothing is communicated and the local LQR stabilizes every robot. The
    margin is the first probability at which it is lost, found from ``TRIED`` ones, with the peaks between them, and
    narrowed down to rounding.

    Args:
        formation: the linearized closed loop.
        period_s: sampling period T (s).
        lost: what stands in for a lost packet.

    Returns:
        The margin.

    Raises:
        IllPosedError: there is one robot, or the loop is unstable without any loss, sampled or not.
        ValueError: the period is not finite and above 0, or there is no such ``lost``.
    """
    if not 0 < period_s < np.inf:
        raise ValueError(f"the sampling period is {period_s} s; it must be finite and above 0")
    if formation.robots < 2:
        raise IllPosedError("one robot has no channels: a loss margin needs at least two robots")
    longest = longest_period(formation, up_to_s=max(1.0, 2 * period_s))
    loop = sampled_loop(formation, period_s, lost)
    if np.abs(np.linalg.eigvals(loop.mean(1.0))).max() >= 1:
        raise IllPosedError(
            f"sampled every {1e3 * period_s:.3g} ms the loop is unstable even without loss: it has no loss margin"
            + (f"; periods below {1e3 * longest:.3g} ms are stable" if longest else "")
        )
    return LossMargin(_first_loss(loop), period_s, lost, longest)


def stable_losses(loop: SampledLoop) -> Iterator[Interval]:
    """The loss probabilities at which x(k+1) = (base + Σ γ_c into_c out_c) x(k) is stable in mean square.

    ``TRIED`` ones are looked at up to ``HIGHEST``, with the peaks and dips between them. One less the first upper end
    is the critical arrival probability: for x(k+1) = a x(k) + γ u(k), |a| > 1, whatever u, 1 − 1/a² at best (Schenato
    et al. 2007).

    Args:
        loop: one period of a loop with packets, of which each is lost independently with the same probability.

    Yields:
        Each interval, ascending, as soon as it is found.
    """

    def excess(odds: float) -> float:
        """Negative where the gain is below 1, by the logarithm of the odds p/(1 − p); finite also where that is not."""
        return 1 - 1 / max(mean_square_gain(loop, 1 / (1 + np.exp(odds))), 1e-9)

    furthest = float(np.log(HIGHEST / (1 - HIGHEST)))
    points = [NO_LOSS, *np.linspace(-furthest, furthest, TRIED)]
    for low, high in where_negative(excess, points):
        yield Interval(*(0.0 if end == NO_LOSS else float(1 / (1 + np.exp(-end))) for end in (low, high)))


def _first_loss(loop: SampledLoop) -> float | None:
    """The first loss probability at which the mean-square gain reaches 1; None where it does not up to ``HIGHEST``."""
    if not loop.out.any():
        return None
    high = next(stable_losses(loop)).high
    return high if high < HIGHEST * (1 - 1e-12) else None
