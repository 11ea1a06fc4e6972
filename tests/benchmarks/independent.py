"""The whole formation as one vectorised right-hand side for SciPy: an independent solution to measure errors by."""

import numpy as np
from scipy.integrate import solve_ivp

from drake_formation.formation import graphs
from drake_formation.scenario import resolve


def solve(scenario, times):
    """States at the given times of a scenario that starts at transport, shape (times, N, 4), to about 1e-9 m."""
    slots, start = resolve(scenario).slots, resolve(scenario).starts
    count = len(slots)
    springs = graphs.laplacian(resolve(scenario).springs.graph) < -0.5
    talks = resolve(scenario).channels.laplacian
    rest = np.linalg.norm(slots[:, None] - slots, axis=-1)
    goal, mass = np.array(scenario.transport.goal), resolve(scenario).masses[:, None]
    k, delta, avoidance = scenario.springs.stiffness, scenario.consensus.delta, scenario.avoidance
    centres = np.array([obstacle.position for obstacle in avoidance.obstacles])

    def slope(_time, state):
        q, v = state.reshape(2, count, 2)
        between = q[:, None] - q
        distance = np.linalg.norm(between, axis=-1)
        np.fill_diagonal(distance, 1.0)
        pull = -np.sum((springs * k * (1 - rest / distance))[..., None] * between, axis=1)
        agree = -delta * talks @ (q - slots)
        track = -(q - slots - goal) - 9 * v
        away = q[:, None] - centres
        rho = np.linalg.norm(away, axis=-1)
        push = avoidance.gain * np.maximum(1 / rho - 1 / avoidance.range, 0) / rho**3
        force = pull + agree + track + np.sum(push[..., None] * away, axis=1)
        return np.concatenate([v, force / mass]).ravel()

    initial = np.concatenate([start, np.zeros_like(start)]).ravel()
    solution = solve_ivp(
        slope, (times[0], times[-1]), initial, "DOP853", t_eval=times, rtol=1e-10, atol=1e-12, max_step=0.02
    )
    q, v = solution.y.T.reshape(-1, 2, count, 2).transpose(1, 0, 2, 3)
    return np.concatenate([q, v], axis=-1)
