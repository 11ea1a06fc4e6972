"""The formation in JAX, integrated by diffrax: one run, and many at once by vmap."""

import os

# XLA would otherwise run one vmapped program on one processor only.
os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=true")

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
import peers

jax.config.update("jax_enable_x64", True)


def right_hand_side(scenario):
    """``f(t, x, (k, δ))`` of a complete formation, vectorised over pairs."""
    slots, masses, gain, goal, _, damping, _, delta_v, obstacles, reach, push = peers.parameters(scenario)
    between = slots[:, None] - slots[None]
    rest = np.linalg.norm(between, axis=-1)
    others = 1.0 - np.eye(len(masses))

    def f(t, x, gains):
        stiffness, delta = gains
        q, v = x.reshape(-1, 4)[:, :2], x.reshape(-1, 4)[:, 2:]
        error = jnp.concatenate([q - goal - slots, v], axis=1)
        force = -error @ gain.T
        r, w = q[:, None] - q[None], v[:, None] - v[None]
        square = (r**2).sum(-1) + (1.0 - others)
        tension = stiffness * (1.0 - rest / jnp.sqrt(square)) + damping * (r * w).sum(-1) / square
        pull = (others * tension)[..., None] * r + others[..., None] * (delta * (r - between) + delta_v * w)
        force = force - pull.sum(1)
        o = q[:, None] - obstacles[None, :, :2]
        distance = jnp.sqrt((o**2).sum(-1))
        clearance = distance - obstacles[:, 2]
        size = push * jnp.maximum(1.0 / clearance - 1.0 / reach, 0.0) / (clearance**2 * distance)
        force = force + (size[..., None] * o).sum(1)
        return jnp.concatenate([v, force / masses[:, None]], axis=1).ravel()

    return f


def solver(scenario, start, seconds, accuracy):
    """``solve(k, δ)``: states at every second, by Dormand-Prince 5(4)."""
    term = diffrax.ODETerm(right_hand_side(scenario))
    saved = diffrax.SaveAt(ts=jnp.arange(1.0, seconds + 1.0))
    control = diffrax.PIDController(rtol=0.0, atol=accuracy, norm=lambda e: jnp.max(jnp.abs(e)), dtmax=0.1)

    def solve(stiffness, delta):
        solution = diffrax.diffeqsolve(
            term, diffrax.Dopri5(), 0.0, float(seconds), 0.01, jnp.asarray(start), args=(stiffness, delta),
            saveat=saved, stepsize_controller=control, max_steps=None, throw=False,
        )  # fmt: skip
        return solution.ys

    return solve


def one(scenario, start, seconds, accuracy):
    """A function without arguments: the scenario's own run, compiled."""
    solve = jax.jit(solver(scenario, start, seconds, accuracy))
    gains = float(scenario.springs.stiffness), float(scenario.consensus.delta)
    return lambda: np.asarray(solve(*gains))


def many(scenario, start, seconds, accuracy, stiffnesses, deltas, parts):
    """A function without arguments: all runs at once on as many threads as there are parts, by vmap."""
    from concurrent.futures import ThreadPoolExecutor

    solve = jax.jit(jax.vmap(solver(scenario, start, seconds, accuracy)))
    chunks = list(zip(np.array_split(stiffnesses, parts), np.array_split(deltas, parts), strict=True))
    pool = ThreadPoolExecutor(parts)
    return lambda: np.concatenate(list(pool.map(lambda chunk: np.asarray(solve(*chunk)), chunks)))
