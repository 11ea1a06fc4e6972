"""What no communication graph with so many edges can do better: somebody in it has few neighbours.

The relative modes of a formation of equal robots answer one by one, each as a function f of one number (its Laplacian
eigenvalue, or its stiffness). What a robot does when it is hit itself is a mean of these answers, and the same mean of
the numbers is its own diagonal element: its number of neighbours N/(N − 1), or its stiffness. So its answer is at least
what a line that supports f says there (Jensen's inequality), and with E edges some robot has at most 2E/N neighbours.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import STATES, LinearFormation
from drake_formation.analysis.linear.norms import steady_covariance
from drake_formation.analysis.response.disturbance import error_outputs
from drake_formation.analysis.response.error_criteria import ForceNoise, Measure, Pulse
from drake_formation.analysis.topology.reduced_graphs import interchangeable

Array = NDArray[np.float64]

SLACK = 1e-3
"""What a bound is lowered by, relative: more than its grid of numbers may miss."""

_POINTS = 401
_PER_OCTAVE = 16
_POSITIONS, _RATES = slice(0, 2), slice(2, 4)


def least_error(complete: LinearFormation, measure: Measure) -> Callable[[int], float]:
    """A bound that the error of every graph with so many edges exceeds (m).

    It is known for :class:`Pulse` and :class:`ForceNoise`, for robots any two of which can be swapped, and for robots
    that share one damping coefficient and a symmetric stiffness (equal robots, δ_v = 0, springs of any kind without
    damping). Otherwise the bound is 0.

    Args:
        complete: the formation on the complete graph.
        measure: which error.
    """
    modes = relative_modes(complete)
    if modes is None or not isinstance(measure, ForceNoise | Pulse):
        return _nothing_known
    share = (complete.robots - 1) / complete.robots
    if isinstance(measure, ForceNoise):
        squares = share * modes.least_means(modes.variances()[None])
        errors = measure.density_n_per_sqrt_hz * np.sqrt(squares)
    else:
        errors = measure.impulse_ns * share * modes.least_means(modes.responses())
    # The robot with the fewest neighbours may have fewer still.
    by_degree = (1 - SLACK) * np.minimum.accumulate(errors)
    return lambda edges: float(by_degree[2 * edges // complete.robots - 1])


def _nothing_known(_edges: int) -> float:
    return 0.0


@dataclass(frozen=True)
class RelativeModes:
    """The relative modes as one family of loops with four states, ẋ = (fixed + p · varied) x + force f.

    Attributes:
        fixed: shape (4, 4).
        varied: shape (4, 4).
        force: shape (4, 2).
        numbers: values that p may take on any graph, ascending.
        alone: mean of p, as each robot sees the modes, without communication; shape (N,).
        per_neighbour: what every neighbour adds to a robot's mean.
    """

    fixed: Array
    varied: Array
    force: Array
    numbers: Array
    alone: Array
    per_neighbour: float

    def loops(self) -> Array:
        """State matrices of all numbers, shape (numbers, 4, 4)."""
        loops: Array = self.fixed + self.numbers[:, None, None] * self.varied
        return loops

    def variances(self) -> Array:
        """Variance of the position under white force noise of one-sided unit density, shape (numbers,)."""
        intensity = self.force @ self.force.T / 2
        return np.array([np.trace(steady_covariance(loop, intensity)[_POSITIONS, _POSITIONS]) for loop in self.loops()])

    def responses(self) -> Array:
        """Position along the force after a unit impulse, mean of both axes, shape (times, numbers)."""
        from scipy.linalg import expm

        loops = self.loops()
        values = np.linalg.eigvals(loops)
        first = 0.05 / np.abs(values).max()
        octaves = int(np.ceil(np.log2(10 / np.abs(values.real).min() / first)))
        step = expm(loops * first / _PER_OCTAVE)
        motion = np.linalg.matrix_power(step, _PER_OCTAVE)
        result = []
        for _ in range(_PER_OCTAVE):
            later = motion
            for _ in range(octaves):
                result.append(np.trace((later @ self.force)[:, _POSITIONS], axis1=1, axis2=2) / 2)
                later = later @ later
            motion = motion @ step
        return np.array(result)

    def least_means(self, answers: Array) -> Array:
        """Least mean of an answer, of any robot with 1 … N − 1 neighbours.

        Args:
            answers: shape (rows, numbers); the row that says most counts.
        """
        slopes = np.gradient(answers, self.numbers, axis=1)

        def least(mean: float) -> float:
            nearest = int(np.abs(self.numbers - mean).argmin())
            lines = slopes[:, nearest, None] * (self.numbers - mean)
            return float((answers - lines).min(axis=1).max())

        robots = np.unique(np.round(self.alone, 12))
        degrees = range(1, len(self.alone))
        return np.array([min(least(alone + self.per_neighbour * k) for alone in robots) for k in degrees])


def relative_modes(complete: LinearFormation) -> RelativeModes | None:
    """The relative modes of a formation, where they are one family."""
    return _interchangeable_modes(complete) if interchangeable(complete) else _stiffness_modes(complete)


def _interchangeable_modes(complete: LinearFormation) -> RelativeModes:
    """Robots that can be swapped: one mode for every Laplacian eigenvalue."""
    robots = complete.robots

    def relative(part: Array) -> Array:
        difference: Array = part[:STATES, :STATES] - part[:STATES, STATES : 2 * STATES]
        return difference

    return RelativeModes(
        fixed=relative(complete.tracking + complete.springs),
        # On the complete graph every relative mode has the eigenvalue N.
        varied=relative(complete.consensus(complete.delta, complete.delta_v)) / robots,
        force=complete.B[:STATES, :2],
        numbers=np.linspace(0.0, robots, _POINTS),
        alone=np.zeros(robots),
        per_neighbour=robots / (robots - 1),
    )


def _stiffness_modes(complete: LinearFormation) -> RelativeModes | None:
    """Robots that share one damping coefficient: one mode for every eigenvalue of the symmetric stiffness."""
    fixed, talk = complete.tracking + complete.springs, complete.consensus(complete.delta, complete.delta_v)
    stiffness, added = -_block(fixed, _RATES, _POSITIONS), -_block(talk, _RATES, _POSITIONS)
    damping = -_block(fixed + talk, _RATES, _RATES)
    push = complete.B.reshape(-1, STATES, complete.B.shape[1])[:, _RATES].reshape(damping.shape)
    even = np.eye(len(damping))
    pieces = ((damping, damping[0, 0] * even), (push, push[0, 0] * even), (stiffness, stiffness.T), (added, added.T))
    if any(np.abs(one - other).max() > 1e-9 * np.abs(one).max() for one, other in pieces):
        return None
    positions = _block(np.eye(len(fixed)), _POSITIONS, _POSITIONS)
    relative = error_outputs(complete.robots).reshape(len(even), -1, STATES)[..., _POSITIONS].reshape(positions.shape)
    if np.abs(relative @ stiffness - stiffness @ relative).max() > 1e-9 * np.abs(stiffness).max():
        return None
    alone = np.sort(np.linalg.eigvalsh(relative @ stiffness @ relative))[2:]
    together = np.sort(np.linalg.eigvalsh(relative @ (stiffness + added) @ relative))[2:]
    if together.max() - alone.min() <= 1e-9 * together.max():
        return None
    share = (complete.robots - 1) / complete.robots
    each = [np.diag(relative @ part @ relative).reshape(-1, 2).mean(axis=1) / share for part in (stiffness, added)]
    return RelativeModes(
        fixed=np.kron(np.array([[0.0, 1.0], [0.0, -damping[0, 0]]]), np.eye(2)),
        varied=np.kron(np.array([[0.0, 0.0], [-1.0, 0.0]]), np.eye(2)),
        force=np.kron(np.array([[0.0], [push[0, 0]]]), np.eye(2)),
        numbers=np.linspace(alone.min(), together.max(), _POINTS),
        alone=each[0],
        per_neighbour=float(each[1].mean()) / (complete.robots - 1),
    )


def _block(matrix: Array, rows: slice, columns: slice) -> Array:
    """Some states' effect on others, for all robots, shape (2N, 2N)."""
    robots = len(matrix) // STATES
    result: Array = matrix.reshape(robots, STATES, robots, STATES)[:, rows, :, columns].reshape(2 * robots, -1)
    return result
