"""The formation as symbolic expressions for heyoka (Taylor series) and CasADi (CVODES of SUNDIALS), one force a pair.

heyoka compiles eight robots for a minute or two; its compact mode compiles at once and runs several times as long.
"""

from functools import cache

import casadi
import heyoka
import numpy as np
import peers

STEP_CAP = 0.02
"""Longest step of the Taylor method (s): its error estimate does not see the kink where an obstacle is first felt."""

TOLERANCE = 1e-8
"""Relative and absolute, of CVODES."""


def derivatives(scenario, x, stiffness, delta, sqrt, positive):
    """The right-hand side in terms of any symbols that have arithmetic."""
    slots, masses, gain, goal, _, damping, _, delta_v, obstacles, reach, push = peers.parameters(scenario)
    count = len(masses)
    forces = []
    for i in range(count):
        qx, qy, vx, vy = x[4 * i : 4 * i + 4]
        errors = [qx - (goal[0] + slots[i, 0]), qy - (goal[1] + slots[i, 1]), vx, vy]
        force = [-sum(float(k) * e for k, e in zip(row, errors, strict=True) if k) for row in gain]
        for ox, oy, radius in obstacles:
            away = qx - float(ox), qy - float(oy)
            distance = sqrt(away[0] ** 2 + away[1] ** 2)
            clearance = distance - float(radius)
            size = push * positive(1 / clearance - 1 / reach) / (clearance**2 * distance)
            force = [f + size * a for f, a in zip(force, away, strict=True)]
        forces.append(force)
    for i in range(count):
        for j in range(i):
            r = [x[4 * i + k] - x[4 * j + k] for k in range(4)]
            h = slots[i] - slots[j]
            square = r[0] ** 2 + r[1] ** 2
            tension = stiffness * (1 - float(np.hypot(*h)) / sqrt(square))
            if damping[i, j]:
                tension = tension + float(damping[i, j]) * (r[0] * r[2] + r[1] * r[3]) / square
            for k in range(2):
                pull = tension * r[k] + delta * (r[k] - float(h[k]))
                if delta_v:
                    pull = pull + delta_v * r[k + 2]
                forces[i][k] = forces[i][k] - pull
                forces[j][k] = forces[j][k] + pull
    return [
        part for i in range(count) for part in (x[4 * i + 2], x[4 * i + 3], *(f / float(masses[i]) for f in forces[i]))
    ]


def taylor(scenario, start):
    """heyoka's integrator; its parameters are the stiffness and δ."""
    names = [f"x{k}" for k in range(len(start))]
    x = list(heyoka.make_vars(*names))
    slopes = derivatives(scenario, x, heyoka.par[0], heyoka.par[1], heyoka.sqrt, heyoka.relu)
    return heyoka.taylor_adaptive(
        list(zip(x, slopes, strict=True)),
        np.array(start),
        pars=[scenario.springs.stiffness, scenario.consensus.delta],
    )


def heyoka_one(scenario, start, seconds):
    """A run to every second, shape (seconds, 4N)."""
    integrator, grid = taylor(scenario, start), np.arange(0.0, seconds + 1.0)

    def run():
        integrator.time = 0.0
        integrator.state[:] = start
        return integrator.propagate_grid(grid, max_delta_t=STEP_CAP)[-1][1:]

    return run


def heyoka_many(scenario, start, seconds, stiffnesses, deltas):
    """Runs over stiffness and δ on all processors, shape (runs, seconds, 4N)."""
    integrator, grid = taylor(scenario, start), np.arange(0.0, seconds + 1.0)

    def generator(one, index):
        one.time = 0.0
        one.state[:] = start
        one.pars[:] = [stiffnesses[index], deltas[index]]
        return one

    def run():
        found = heyoka.ensemble_propagate_grid(integrator, grid, len(deltas), generator, max_delta_t=STEP_CAP)
        return np.array([each[-1][1:] for each in found])

    return run


@cache
def _cvodes(scenario_json, size, seconds):
    from drake_formation import Scenario

    scenario = Scenario.model_validate_json(scenario_json)
    x, p = casadi.SX.sym("x", size), casadi.SX.sym("p", 2)
    slopes = derivatives(scenario, casadi.vertsplit(x), p[0], p[1], casadi.sqrt, lambda value: casadi.fmax(value, 0.0))
    problem = {"x": x, "p": p, "ode": casadi.vertcat(*slopes)}
    grid = np.arange(1.0, seconds + 1.0).tolist()
    options = {"abstol": TOLERANCE, "reltol": TOLERANCE, "max_step_size": 0.1, "max_num_steps": 1000000}
    return casadi.integrator("formation", "cvodes", problem, 0.0, grid, options)


def casadi_one(scenario, start, seconds):
    """A run to every second, shape (seconds, 4N)."""
    integrator = _cvodes(scenario.model_dump_json(), len(start), seconds)
    p = [scenario.springs.stiffness, scenario.consensus.delta]
    return lambda: np.array(integrator(x0=start, p=p)["xf"]).T


def casadi_many(scenario, start, seconds, stiffnesses, deltas, processors):
    """Runs over stiffness and δ on all processors, shape (runs, seconds, 4N)."""
    integrator = _cvodes(scenario.model_dump_json(), len(start), seconds)
    mapped = integrator.map(len(deltas), "thread", processors)
    p, x0 = np.vstack([stiffnesses, deltas]), np.tile(np.array(start)[:, None], len(deltas))

    def run():
        found = np.array(mapped(x0=x0, p=p)["xf"])
        return found.T.reshape(len(deltas), seconds, len(start))

    return run
