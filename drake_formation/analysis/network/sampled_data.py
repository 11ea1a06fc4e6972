"""The loop as a network runs it: channels carry packets once a period, and forces are held in between.

At t = kT every robot computes its consensus force from its own sampled state and what its channels brought, and holds
it for the period T. Plants, springs and local LQR go on continuously, so that one period is exactly
x(kT + T) = e^{AT} x(kT) + Ψ(T) a, with Ψ(T) = ∫ e^{As} ds over the period and a the accelerations held.
"""

from dataclasses import dataclass
from itertools import islice
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.analysis.linear.block_diagonal import blocks
from drake_formation.analysis.linear.linearization import STATES, LinearFormation
from drake_formation.analysis.network.delay_crossings import require_stable
from drake_formation.analysis.network.intervals import Interval, where_negative
from drake_formation.formation import graphs

Array = NDArray[np.float64]

Lost = Literal["zero", "hold"]
"""What stands in for a lost packet ("to zero or to hold", Schenato 2009): ``zero``, the term of its channel is left out
for the period; ``hold``, the robot goes on with what it received last from that neighbour."""

STEPS_PER_CYCLE = 80
"""Sampling periods tried within one cycle of the fastest mode."""

SHORTEST = 1e-6
"""The first period tried, in steps between the others: there the loop is as in continuous time."""


@dataclass(frozen=True)
class SampledLoop:
    """One period of the loop, x(k+1) = (base + Σ γ_c into_c out_c) x(k): γ_c is 1 if the packet of channel c arrives.

    Attributes:
        base: the period without any packet, shape (n, n).
        into: what that which is received does, by place, shape (places, n, m); here accelerations, m = 2.
        out: what a packet of each channel brings, shape (channels, m, n).
        place: where each channel's goes, shape (channels,): to its robot, or to a memory of its own.
    """

    base: Array
    into: Array
    out: Array
    place: NDArray[np.int64]

    def mean(self, arrival: ArrayLike) -> Array:
        """The mean period where packets arrive with a probability, of all channels or of each, shape (n, n)."""
        arrivals = np.broadcast_to(np.asarray(arrival, dtype=float), self.place.shape)
        per_place = np.zeros((len(self.into), *self.out.shape[1:]))
        np.add.at(per_place, self.place, arrivals[:, None, None] * self.out)
        places, size, each = self.into.shape
        entering = self.into.transpose(1, 0, 2).reshape(size, places * each)
        result: Array = self.base + entering @ per_place.reshape(places * each, size)
        return result


def sampled_loop(formation: LinearFormation, period_s: float, lost: Lost = "zero") -> SampledLoop:
    """The loop with the scenario's gains, sampled.

    Args:
        formation: the linearized closed loop.
        period_s: sampling period T (s).
        lost: what stands in for a lost packet; ``hold`` adds two states for every channel, the acceleration that what
            was received last amounts to.

    Raises:
        ValueError: there is no such ``lost``.
    """
    flow, held = period(formation.tracking + formation.springs, period_s)
    consensus = formation.consensus(formation.delta, formation.delta_v)
    to, of = channels(formation)
    at = STATES * np.arange(formation.robots)[:, None] + np.arange(STATES)
    hears, feels = np.zeros((2, len(to), 2, len(flow)))
    for c, (i, j) in enumerate(zip(to, of, strict=True)):
        pull = consensus[np.ix_(at[i, 2:], at[j])]
        hears[c][:, at[j]], feels[c][:, at[i]] = pull, pull
    into = held[:, at[:, 2:]].transpose(1, 0, 2)
    if lost == "zero":
        return SampledLoop(flow, into, hears - feels, to)
    if lost == "hold":
        return _with_memory(flow, into[to], hears, feels)
    raise ValueError(f"a lost packet cannot be {lost!r}; there are zero, hold")


def _with_memory(flow: Array, into: Array, hears: Array, feels: Array) -> SampledLoop:
    """Each channel's memory w: force w⁺ − feels x, with w⁺ = w + γ (hears x − w)."""
    count, _, size = hears.shape
    memory = np.eye(2 * count).reshape(count, 2, 2 * count)
    base = np.eye(size + 2 * count)
    base[:size, :size] = flow - np.einsum("cnk,ckm->nm", into, feels)
    base[:size, size:] = np.einsum("cnk,ckm->nm", into, memory)
    longer = np.concatenate([into, memory.transpose(0, 2, 1)], axis=1)
    return SampledLoop(base, longer, np.concatenate([hears, -memory], axis=2), np.arange(count))


def channels(formation: LinearFormation) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The robot each channel goes to, and the one it comes from; numbered from 0, one channel each way an edge."""
    graph = formation.resolved.channels.graph
    pairs = [(i, j) for i in range(formation.robots) for j in graphs.neighbours(graph, i)]
    to, of = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    return to, of


def period(matrix: Array, period_s: float) -> tuple[Array, Array]:
    """e^{AT} and its integral Ψ(T), each of shape (n, n), for a period T (s)."""
    from scipy.linalg import expm

    size = len(matrix)
    both = np.zeros((2 * size, 2 * size))
    both[:size, :size], both[:size, size:] = matrix, np.eye(size)
    both = expm(both * period_s)
    return both[:size, :size], both[:size, size:]


def stable_periods(
    present: ArrayLike, sampled: ArrayLike, *, up_to: float, stop_at_first: bool = False
) -> tuple[Interval, ...]:
    """The sampling periods T at which ẋ = A₀ x(t) + A₁ x(kT), kT ≤ t < kT + T, is asymptotically stable.

    State feedback u = −K x that is held is A₁ = −B K. Periods are tried in steps of a fraction of the fastest mode's
    cycle, and between them where growth is largest or smallest.

    Args:
        present: A₀, what acts continuously (1/s), shape (n, n).
        sampled: A₁, what acts as it was at the last sample (1/s), shape (n, n).
        up_to: longer periods are not looked at (s).
        stop_at_first: leave out all intervals but the first.

    Returns:
        The intervals (s), ascending.
    """
    always, held_back = (np.atleast_2d(np.asarray(matrix, dtype=float)) for matrix in (present, sampled))

    def growth(period_s: float) -> float:
        flow, held = period(always, period_s)
        radius = np.abs(np.linalg.eigvals(flow + held @ held_back)).max()
        return float(np.log(max(radius, np.finfo(float).tiny))) / period_s

    fastest = max(np.abs(np.linalg.eigvals(matrix)).max() for matrix in (always, always + held_back))
    count = max(1, int(np.ceil(up_to * fastest * STEPS_PER_CYCLE / (2 * np.pi))))
    times = up_to * np.arange(1, count + 1) / count
    found = where_negative(growth, [SHORTEST * times[0], *times])
    intervals = islice(found, 1) if stop_at_first else found
    # Periods down to none are like the shortest tried.
    return tuple(Interval(0.0 if low == SHORTEST * times[0] else low, high) for low, high in intervals)


def longest_period(formation: LinearFormation, *, up_to_s: float = 1.0) -> float | None:
    """The longest sampling period that the loop tolerates where no packet is lost.

    A force held for T is T/2 late on average, so for short periods this is twice the delay margin of the whole
    relative term. See :func:`stable_periods` for how it is found.

    Args:
        formation: the linearized closed loop.
        up_to_s: longer periods are not looked at (s).

    Returns:
        The period up to which all shorter ones are stable (s), or None: all up to ``up_to_s`` are.

    Raises:
        IllPosedError: it is unstable even in continuous time.
    """
    alone, consensus = formation.tracking + formation.springs, formation.consensus(formation.delta, formation.delta_v)
    require_stable(alone + consensus)
    longest = up_to_s
    for part in blocks([alone, consensus], formation.resolved.masses):
        longest = stable_periods(*part, up_to=longest, stop_at_first=True)[0].high
    return longest if longest < up_to_s else None
