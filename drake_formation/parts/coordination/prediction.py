"""What a plan of forces makes of the formation's errors over a horizon, and what that costs."""

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.controllers import DiscreteTimeLinearQuadraticRegulator

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SampledModel:
    """The linear formation under forces that are held for a period: ε⁺ = A ε + B u, with costs by sample.

    Attributes:
        a: A, shape (4N, 4N).
        b: B, shape (4N, 2N).
        state_cost: of every sample's errors, shape (4N, 4N).
        input_cost: of every sample's forces, shape (2N, 2N).
        cost_to_go: what errors cost from a sample on for ever, by the optimal forces, shape (4N, 4N).
    """

    a: Array
    b: Array
    state_cost: Array
    input_cost: Array
    cost_to_go: Array

    def pack(self) -> Array:
        """All in one row, as a numeric parameter takes it."""
        return np.concatenate([matrix.ravel() for matrix in vars(self).values()])

    @classmethod
    def unpack(cls, numbers: Array, robots: int) -> "SampledModel":
        """What :meth:`pack` gave for so many robots."""
        states, forces = 4 * robots, 2 * robots
        shapes = [(states, states), (states, forces), (states, states), (forces, forces), (states, states)]
        pieces = np.split(numbers, np.cumsum([rows * columns for rows, columns in shapes])[:-1])
        return cls(*(piece.reshape(shape) for piece, shape in zip(pieces, shapes, strict=True)))


def sampled(a: Array, b: Array, state_cost: Array, input_cost: Array, period: float) -> SampledModel:
    """A continuous model ε̇ = A ε + B u and its cost rates, sampled with a period (s).

    Raises:
        RuntimeError, SystemExit: Drake finds no optimal forces for it.
    """
    from scipy.linalg import expm  # slow to import

    states, forces = b.shape
    motion = np.zeros((states + forces, states + forces))
    motion[:states] = np.hstack([a, b])
    step = expm(period * motion)[:states]
    model = step[:, :states], step[:, states:], period * state_cost, period * input_cost
    gain, cost_to_go = DiscreteTimeLinearQuadraticRegulator(*model)
    loop = model[0] - model[1] @ gain
    if not (np.isfinite(loop).all() and np.abs(np.linalg.eigvals(loop)).max() < 1):
        raise RuntimeError("the forces do not stabilize")
    return SampledModel(*model, cost_to_go)


@dataclass(frozen=True)
class Prediction:
    """Errors at the samples 1 … H as a linear function of those now and of a plan u_0 … u_(H−1), all in one row.

    Attributes:
        free: what becomes of the errors by themselves, shape (H, 4N, 4N).
        forced: what the plan does, shape (H, 4N, 2NH).
        hessian: of the cost by the plan, shape (2NH, 2NH).
        slope: gradient of the cost by the plan, at the plan 0, for every unit of the errors now, shape (2NH, 4N).
        best: the plan of least cost for every unit of the errors now, shape (2NH, 4N).
    """

    free: Array
    forced: Array
    hessian: Array
    slope: Array
    best: Array

    @property
    def robots(self) -> int:
        """Number of robots N."""
        return int(self.free.shape[1]) // 4

    @property
    def horizon(self) -> int:
        """Number of samples H."""
        return len(self.free)

    def paths(self, slots: Array, centre: Array, period: float, errors: Array) -> Array:
        """Where errors lead the robots if they exert no force, about a reference that keeps its velocity.

        Args:
            slots: h of every robot (m), shape (N, 2).
            centre: [p; ṗ] of the reference now (m, m/s), shape (4,).
            period: between samples (s).
            errors: ε now (m, m/s), shape (4N,).

        Returns:
            Positions at the samples 1 … H (m), shape (H, N, 2).
        """
        ahead = period * np.arange(1, self.horizon + 1)[:, None, None]
        moved: Array = (self.free @ errors).reshape(self.horizon, self.robots, 4)[..., :2]
        return moved + slots + centre[:2] + ahead * centre[2:]

    @property
    def shifts(self) -> Array:
        """By how much every newton of the plan shifts the robots at the samples (m/N), shape (H, N, 2, 2NH)."""
        return self.forced.reshape(self.horizon, self.robots, 4, -1)[:, :, :2]


@functools.lru_cache(maxsize=4)  # they are large, and a run needs two
def prediction(packed: bytes, robots: int, horizon: int) -> Prediction:
    """The prediction of a :meth:`SampledModel.pack`, as bytes; all robots of a formation share one."""
    model = SampledModel.unpack(np.frombuffer(packed), robots)
    states, forces = model.b.shape
    free = np.empty((horizon, states, states))
    plan = np.zeros((horizon, states, horizon, forces))
    motion, push = np.eye(states), model.b
    for k in range(horizon):
        for sample in range(k, horizon):  # a force acts alike, however late it is exerted
            plan[sample, :, sample - k] = push
        motion, push = model.a @ motion, model.a @ push
        free[k] = motion
    forced: Array = plan.reshape(horizon, states, horizon * forces)
    weights = np.array([model.state_cost] * (horizon - 1) + [model.cost_to_go])
    felt = np.einsum("kij,kil->kjl", weights, forced)  # weights are symmetric
    hessian = 2 * (np.einsum("kij,kil->jl", forced, felt) + np.kron(np.eye(horizon), model.input_cost))
    slope = 2 * np.einsum("kij,kil->jl", felt, free)
    return Prediction(free, forced, hessian, slope, -np.linalg.solve(hessian, slope))
