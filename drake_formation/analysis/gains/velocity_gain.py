"""δ_v for a damping ratio of the slowest consensus mode.

A mode of displacements φ has mass m = φᵀMφ, damping φᵀDφ + λ δ_v and stiffness k = φᵀKφ, with λ = φᵀ(L ⊗ I)φ, so

    m s² + (d + λ δ_v) s + k = 0,  ζ = (d + λ δ_v) / (2 √(m k)).

For identical robots with isotropic tracking this is exact (λ is the algebraic connectivity and k = k_p + λ δ, plus what
the object's springs add) and δ_v follows at once. Otherwise damping mixes the modes; then ζ is that of the pair of
eigenvalues that begins as the mode at δ_v = 0, followed as δ_v rises (see
:mod:`drake_formation.analysis.gains.eigenvalue_pairs`).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.gains.eigenvalue_pairs import Pair, at, course, pairs_of
from drake_formation.analysis.linear.block_diagonal import bases, reduced
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.linear.motion_subspaces import positions, velocities
from drake_formation.analysis.linear.well_posed import require_agreement
from drake_formation.analysis.response.peak_norm import require_stable
from drake_formation.scenario import resolve

Array = NDArray[np.float64]

LARGEST = 1e3
"""The largest damping ratio (ζ) asked for: the two eigenvalues are then a factor of 4e6 apart."""

_SORTING = 1e-6
"""Share of the stiffness, and relative distance of two stiffnesses, that is nothing but enough to sort modes by."""

_MOST = 1e6
"""Where the search for δ_v ends, in units of what would damp the mode critically if it were alone."""

_ACCURACY = 1e-6
"""How well the eigenvalues found must have the ratio, relative to it."""


@dataclass(frozen=True)
class VelocityGain:
    """A velocity consensus gain for a damping ratio.

    Attributes:
        damping_ratio: ζ of the slowest consensus mode with this gain; above the one requested only if δ_v is 0.
        requested: ζ asked for.
        delta: δ it was found for (N/m).
        delta_v: δ_v (N s/m), 0 where the mode is damped as much without it.
        without: ζ at δ_v = 0.
        frequency: undamped natural frequency √(k/m) of the mode (rad/s).
        decay_rate: how fast the mode dies out with this gain (1/s).
        laplacian_eigenvalue: λ of the mode; the algebraic connectivity where robots are identical.
        closed_form: whether the quadratic alone gave δ_v; otherwise a root find did.
        least_damping_ratio: the least damping ratio of all modes of the loop with this gain.
    """

    damping_ratio: float
    requested: float
    delta: float
    delta_v: float
    without: float
    frequency: float
    decay_rate: float
    laplacian_eigenvalue: float
    closed_form: bool
    least_damping_ratio: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "damping_ratio": self.damping_ratio,
            "requested_damping_ratio": self.requested,
            "delta_n_per_m": self.delta,
            "delta_v_n_s_per_m": self.delta_v,
            "damping_ratio_without": self.without,
            "frequency_rad_per_s": self.frequency,
            "decay_rate_1_per_s": self.decay_rate,
            "laplacian_eigenvalue": self.laplacian_eigenvalue,
            "closed_form": self.closed_form,
            "least_damping_ratio": self.least_damping_ratio,
        }


@dataclass(frozen=True)
class _SlowestMode:
    """The slowest consensus mode without damping: displacements φ of unit mass, and the numbers of its quadratic."""

    shape: Array
    mass: Array
    damping: float
    stiffness: float
    connectivity: float


@dataclass(frozen=True)
class _Block:
    """A part of the loop that nothing else acts on: without δ_v, per unit of it, and the mode's displacements."""

    at_rest: Array
    per_delta_v: Array
    shape: Array

    def loop(self, delta_v: float) -> Array:
        return self.at_rest + delta_v * self.per_delta_v

    def solved(self, damping_ratio: float) -> Pair:
        """The pair of a block of one mode, by the quadratic."""
        stiffness, damping = -self.at_rest[1]
        delta_v = (2 * damping_ratio * np.sqrt(stiffness) - damping) / -self.per_delta_v[1, 1]
        return pairs_of(self.loop, self.shape, float(delta_v))[0]


@dataclass(frozen=True)
class _Damped:
    """The mode's pair at the gain that damps it, its ratio without, and whether the quadratic gave the gain."""

    pair: Pair
    without: float
    closed_form: bool


def velocity_gain(formation: LinearFormation, *, damping_ratio: float, delta: float | None = None) -> VelocityGain:
    """The smallest δ_v that damps the slowest consensus mode by a ratio.

    The slowest consensus mode is the relative motion with the lowest natural frequency: of the graph's algebraic
    connectivity and, where springs act along the line only, the motion they leave free.

    Args:
        formation: the linearized loop; its own δ_v plays no part.
        damping_ratio: ζ above 0 and at most 1000; 1 is critical damping.
        delta: δ (N/m); the scenario's if not given.

    Returns:
        The gain; its ``damping_ratio`` is that of two eigenvalues of the loop, conjugate or both real.

    Raises:
        IllPosedError: one robot, a graph that is not connected, a damping ratio that is none, a loop that is unstable
            without δ_v or with it, or modes that damping mixes before this one has the ratio.
    """
    require_agreement(formation, "consensus mode to damp")
    if not 0 < damping_ratio <= LARGEST:
        raise IllPosedError(f"a damping ratio is above 0 and at most {LARGEST:g}; {damping_ratio:g} is not")
    delta = formation.delta if delta is None else delta
    require_stable(formation.closed_loop(delta, 0.0), delta, 0.0)
    mode = _slowest_mode(formation, delta)
    moved = _blocks_moved(formation, delta, mode)
    found = max((_damped(block, damping_ratio, mode) for block in moved), key=lambda each: each.pair.gain)
    if found.pair.gain > 0 and not abs(found.pair.damping_ratio / damping_ratio - 1) <= _ACCURACY:
        raise IllPosedError(
            f"δ_v = {found.pair.gain:.3g} N s/m, for a damping ratio of {damping_ratio:g}, is too far apart in size "
            "from the loop's other numbers for its eigenvalues to be computed"
        )
    loop = formation.closed_loop(delta, found.pair.gain)
    require_stable(loop, delta, found.pair.gain)
    values = np.linalg.eigvals(loop)
    return VelocityGain(
        damping_ratio=found.pair.damping_ratio,
        requested=damping_ratio,
        delta=delta,
        delta_v=found.pair.gain,
        without=found.without,
        frequency=float(np.sqrt(mode.stiffness)),
        decay_rate=found.pair.decay_rate,
        laplacian_eigenvalue=float(mode.connectivity / np.mean(_content(mode.shape, mode.shape))),
        closed_form=found.closed_form,
        least_damping_ratio=float(np.min(-values.real / np.abs(values))),
    )


def _blocks_moved(formation: LinearFormation, delta: float, mode: _SlowestMode) -> Iterator[_Block]:
    """The blocks of the loop in which the mode moves."""
    masses = resolve(formation.scenario).masses
    matrices = [formation.closed_loop(delta, 0.0), formation.per_delta_v]
    for basis in bases(matrices, masses):
        shapes, sizes, _ = np.linalg.svd(basis.T @ mode.mass @ mode.shape, full_matrices=False)
        if sizes.max() > 0.5:
            at_rest, per_delta_v = (reduced(matrix, basis, masses) for matrix in matrices)
            yield _Block(at_rest, per_delta_v, shapes[:, sizes > 0.5])


def _damped(block: _Block, damping_ratio: float, mode: _SlowestMode) -> _Damped:
    """The mode's pair in a block at the smallest δ_v that gives it the ratio; of several the one that takes most."""

    def damped(pair: Pair) -> _Damped:
        without = pair.damping_ratio
        if without >= damping_ratio * (1 - 1e-12):
            return _Damped(pair, without, True)
        if len(block.shape) == 1:
            return _Damped(block.solved(damping_ratio), without, True)
        return _Damped(_reached(pair, block, damping_ratio, mode), without, False)

    return max((damped(pair) for pair in pairs_of(block.loop, block.shape)), key=lambda each: each.pair.gain)


def _reached(pair: Pair, block: _Block, damping_ratio: float, mode: _SlowestMode) -> Pair:
    """The pair followed to where it first has the ratio."""
    from scipy.optimize import brentq

    critical = 2 * np.sqrt(mode.stiffness) / mode.connectivity
    most = _MOST * critical * max(damping_ratio, 1.0)
    before = pair
    for onward in course(pair, block.loop, critical * min(damping_ratio, 1.0) / 32):
        if onward.damping_ratio >= damping_ratio:
            excess = partial(_excess, damping_ratio, before, block)
            return _known(before, block, float(brentq(excess, before.gain, onward.gain, rtol=1e-14)))
        if onward.gain > most:
            raise IllPosedError(f"no δ_v up to {most:.3g} N s/m damps the slowest consensus mode by {damping_ratio:g}")
        before = onward
    raise _mixed(before)


def _excess(damping_ratio: float, before: Pair, block: _Block, delta_v: float) -> float:
    """How far the ratio exceeds the one asked for."""
    return _known(before, block, delta_v).damping_ratio - damping_ratio


def _known(before: Pair, block: _Block, delta_v: float) -> Pair:
    found = at(before, block.loop, delta_v)
    if found is None:
        raise _mixed(before)
    return found


def _mixed(before: Pair) -> IllPosedError:
    return IllPosedError(
        f"damping mixes the slowest consensus mode with others: from δ_v = {before.gain:.6g} N s/m on its eigenvalues, "
        f"there of damping ratio {before.damping_ratio:.4g}, meet others or nearly so, and which are the mode's cannot "
        "be told; ratios up to that one have an answer"
    )


def _slowest_mode(formation: LinearFormation, delta: float) -> _SlowestMode:
    """Undamped modes (K, M), less the two that consensus resists least (the whole formation moving), the lowest."""
    from scipy.linalg import eigh

    rows, columns = velocities(formation.robots), positions(formation.robots)
    mass: Array = np.asarray(np.linalg.inv(formation.B[rows]), dtype=float)
    loop = formation.closed_loop(delta, 0.0)
    stiffness, damping = -mass @ loop[np.ix_(rows, columns)], -mass @ loop[np.ix_(rows, rows)]
    graph = -mass @ formation.per_delta[np.ix_(rows, columns)]
    # Where nothing else tells relative modes from the common motion, the least bit of consensus does.
    sorting = _SORTING * np.abs(stiffness).max() / np.abs(graph).max() * graph
    squares, shapes = eigh((stiffness + stiffness.T) / 2 + sorting, (mass + mass.T) / 2)
    relative = np.sort(np.argsort(_content(shapes, graph @ shapes) / _content(shapes, shapes))[2:])
    lowest = squares[relative[0]]
    shape = shapes[:, relative[squares[relative] <= lowest * (1 + 2 * _SORTING)]]
    along = [float(np.trace(shape.T @ matrix @ shape) / shape.shape[1]) for matrix in (damping, stiffness, graph)]
    return _SlowestMode(shape, mass, *along)


def _content(left: Array, right: Array) -> Array:
    result: Array = np.sum(left * right, axis=0)
    return result
