"""Delay margin: how old may be what the robots tell each other?

Every channel has the same constant delay τ. What is delayed differs in kind:

* ``neighbour``: robot i compares its own present state with states its neighbours had τ ago, as on any network;
* ``relative``: it acts on the whole difference, its own state included, τ late, as with slow relative sensing, a slow
  actuator in the consensus loop, or states compared by their time stamps.

Relative delay turns the virtual springs' force by the phase ωτ: negative damping of the fraction sin(ωτ) of
their stiffness. For identical robots of damping d (the local LQR's, N s/m) that uses up d at about τ = d/(λ δ) where
δ_v = 0, with λ the largest Laplacian eigenvalue: on a complete graph d/(N δ). With the paper's d = 9 N s/m and
δ = 1e4 N/m: 0.45 ms, 0.23 ms and 0.11 ms for 2, 4 and 8 robots, half of it at δ = 2e4, whatever the object. The common
motion is left alone.

Neighbour-only delay turns the neighbours' part alone, on a complete graph 1/N of the stiffness of relative motion: the
margin is d/δ whatever N, 0.9 ms and 0.45 ms. But now common motion, too, is compared with the past: a drag of
(N − 1) δ τ (N s/m), with eight robots at the margin seven times the local LQR's damping. The formation is stable, and
late.

Damping is what buys margin. With δ_v for a damping ratio of 0.7 of the relative motion the phase lag tolerated is about
a radian instead of a hundredth, the margin tens of milliseconds. Too much of it costs again: relative velocities are
then integrators in consensus, stable until π m/(2 λ δ_v). Only here do the kinds part altogether: with enough δ_v a
robot's own damping outweighs all that its neighbours can do late, and neighbour-only delay of any length is harmless;
relative delay never is, unless consensus is weaker than the local LQR.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.block_diagonal import blocks, distinct
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import LinearFormation, own
from drake_formation.analysis.network.crossing import Crossing, least
from drake_formation.analysis.network.delay_crossings import first_crossing, require_stable
from drake_formation.analysis.network.intervals import Interval, common
from drake_formation.analysis.network.stable_delays import stable_delays

Array = NDArray[np.float64]

Delayed = Literal["neighbour", "relative"]
"""What is delayed: the neighbours' states, or the robots' whole difference to them."""

LITTLE_LAG = 0.1
"""Phase lag (rad) below which a margin is one of damping only: the virtual springs are hardly damped."""

LARGEST_BLOCK = 32
"""States of a block up to which delays beyond the margin are looked at: seconds; larger ones would take minutes."""


@dataclass(frozen=True)
class DelayMargin:
    """The shortest delay of all channels at which the formation ceases to be stable, and where it is stable again.

    Attributes:
        of: what is delayed.
        delta: consensus gain δ (N/m).
        delta_v: velocity consensus gain δ_v (N s/m).
        delay_s: the margin τ* (s): stable for 0 ≤ τ < τ*; None: stable for every delay.
        frequency_rad_s: frequency of the oscillation that does not decay at τ* (rad/s); None without a limit.
        phase_rad: the lag ω τ* (rad) that uses up the damping, in (0, 2π); None without a limit.
        stable_s: all delays at which it is stable (s); from 0 to τ* first. None: there may be others than these, in
            blocks of more than ``LARGEST_BLOCK`` states.
    """

    of: Delayed
    delta: float
    delta_v: float
    delay_s: float | None
    frequency_rad_s: float | None
    phase_rad: float | None
    stable_s: tuple[Interval, ...] | None

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in their keys."""
        return {
            "of": self.of,
            "delta_n_per_m": self.delta,
            "delta_v_n_s_per_m": self.delta_v,
            "delay_s": self.delay_s,
            "frequency_rad_s": self.frequency_rad_s,
            "phase_rad": self.phase_rad,
            "again_stable_s": None if self.stable_s is None else [list(each) for each in self.stable_s[1:]],
        }

    def meaning(self) -> str:
        """What the number says, in a sentence or two."""
        what = "states from neighbours" if self.of == "neighbour" else "differences to neighbours"
        if self.delta == self.delta_v == 0:
            return "nothing is communicated, so no delay matters"
        if self.delay_s is None or self.frequency_rad_s is None or self.phase_rad is None:
            return f"{what} may be of any age: the formation stays stable"
        text = (
            f"{what} must be younger than {1e3 * self.delay_s:.3g} ms: at that age the robots oscillate for ever at "
            f"{self.frequency_rad_s:.3g} rad/s, by a phase lag of {np.degrees(self.phase_rad):.3g}°"
        )
        if self.phase_rad < LITTLE_LAG:
            text += ". The virtual springs are hardly damped, so hardly any lag is needed; delta_v damps them"
        if self.stable_s is not None and len(self.stable_s) > 1:
            again = " and ".join(f"from {low:.4g} to {high:.4g} s" for low, high in self.stable_s[1:])
            text += f". It is stable again {again}"
        return text


def delay_margin(
    formation: LinearFormation, *, of: Delayed = "neighbour", delta: float | None = None, delta_v: float | None = None
) -> DelayMargin:
    """The delay margin, from the delay eigenvalue problem of every block of the formation.

    All crossings of the imaginary axis are considered, in every block, and the one of least delay is the margin; see
    :func:`~drake_formation.analysis.network.delay_crossings.first_crossing` and
    :func:`~drake_formation.analysis.network.stable_delays.stable_delays`.

    Args:
        formation: the linearized closed loop.
        of: what is delayed, see the head of this module.
        delta: another consensus gain δ than the scenario's (N/m).
        delta_v: another velocity consensus gain δ_v (N s/m).

    Returns:
        The margin; its ``delay_s`` is None where every delay is tolerated.

    Raises:
        IllPosedError: there is one robot, or the loop is unstable without delay.
        ValueError: there is no such ``of``, or a gain is negative or not finite.
    """
    gains = _gains(formation, delta, delta_v)
    present, delayed = delay_parts(formation, of, *gains)
    found = shortest_delay(formation, of=of, delta=delta, delta_v=delta_v)
    parts = distinct(blocks([present, delayed], formation.resolved.masses))
    stable: tuple[Interval, ...] | None = (Interval(0.0, np.inf),)
    for part in parts:
        stable = common(stable, stable_delays(*part)) if stable is not None and len(part[0]) <= LARGEST_BLOCK else None
    if found is None:
        return DelayMargin(of, *gains, None, None, None, stable)
    return DelayMargin(of, *gains, found.delay, found.frequency, found.phase, stable)


def shortest_delay(
    formation: LinearFormation, *, of: Delayed = "neighbour", delta: float | None = None, delta_v: float | None = None
) -> Crossing | None:
    """Where the delay margin ends, alone: what it takes for many of them.

    Takes and refuses what :func:`delay_margin` does.

    Returns:
        The crossing of the margin; None where every delay is tolerated.
    """
    gains = _gains(formation, delta, delta_v)
    if formation.robots < 2:
        raise IllPosedError("one robot has no channels: a delay margin needs at least two robots")
    present, delayed = delay_parts(formation, of, *gains)
    require_stable(present + delayed)
    best: Crossing | None = None
    # The small blocks first: what they find spares the large ones much of the search.
    for part in distinct(blocks([present, delayed], formation.resolved.masses)):
        best = least([best, first_crossing(part[0], part[1], best.delay if best else np.inf)])
    return best


def _gains(formation: LinearFormation, delta: float | None, delta_v: float | None) -> tuple[float, float]:
    gains = (formation.delta if delta is None else delta, formation.delta_v if delta_v is None else delta_v)
    for name, gain in zip(("delta", "delta_v"), gains, strict=True):
        if not 0 <= gain < np.inf:
            raise ValueError(f"{name} is {gain}; it must be finite and not negative")
    return gains


def delay_parts(formation: LinearFormation, of: Delayed, delta: float, delta_v: float) -> tuple[Array, Array]:
    """A₀ and A₁ of ẋ = A₀ x(t) + A₁ x(t − τ), each of shape (4N, 4N), for what is delayed.

    Raises:
        ValueError: there is no such ``of``.
    """
    alone = formation.tracking + formation.springs
    consensus = formation.consensus(delta, delta_v)
    if of == "relative":
        return alone, consensus
    if of == "neighbour":
        return alone + own(consensus), consensus - own(consensus)
    raise ValueError(f"no delay of {of!r}; there are neighbour, relative")
