"""What the compiled diagram costs beside the same formation written by hand in numba: ``make bench``."""

import statistics
import time

import numpy as np
import peers
from numba import njit

from drake_formation import Scenario, build_diagram, load_scenario
from drake_formation.lowering import lower

STIFF = {"springs.stiffness": 3e4, "consensus.delta": 2e4}
IN_FORMATION = {"aggregation.duration": 0, "robots.start": {"centre": [2.5, 3.5]}}


def polygon(robots):
    """Robots in formation, everything coupled with everything."""
    return Scenario.model_validate(
        {
            "name": f"polygon-{robots}",
            "formation": {"shape": "polygon", "robots": robots, "side": 1.0},
            "robots": {"start": {"centre": [0.0, 0.0]}},
            "springs": {"stiffness": 1000.0, "damping": 1.0},
            "consensus": {"delta": 100.0, "delta_v": 1.0},
            "avoidance": {"obstacles": [{"position": [60.0, 5.05]}, {"position": [80.0, 1.9]}]},
            "transport": {"goal": [100.0, 0.0]},
        }
    )


@njit(error_model="numpy")
def repeat(derivatives, times, x, m, table, dx):
    for _ in range(times):
        derivatives(0.0, x, m, table, dx)
        x[0] += 1e-12 * dx[0]


def best(function, *arguments):
    """Least wall time of a few calls (s)."""
    spent = []
    for _ in range(7):
        begin = time.perf_counter()
        function(*arguments)
        spent.append(time.perf_counter() - begin)
    return min(spent), statistics.median(spent)


def compare_derivatives():
    print("One right-hand side, complete graphs (µs, best of 7)\n")
    print("| robots | by hand | compiled diagram | ratio | lower() (s) |\n| --- | --- | --- | --- | --- |")
    for robots in (2, 4, 8, 32, 100):
        scenario = polygon(robots)
        diagram = build_diagram(scenario)
        begin = time.perf_counter()
        compiled = lower(diagram)
        lowering = time.perf_counter() - begin
        context = diagram.CreateDefaultContext()
        x = context.get_continuous_state_vector().CopyToVector()
        x += np.random.default_rng(0).normal(size=len(x)) * 0.1
        values, p, turns = compiled.read(context), peers.parameters(scenario), 2_000_000 // robots**2
        dx, expected = np.empty(len(x)), np.empty(len(x))
        peers.slope(x, p, expected)
        np.testing.assert_allclose(compiled.derivatives(0.0, x, values), expected, rtol=1e-9, atol=1e-9)
        code = compiled._derivatives
        repeat(code, 1, x, values, compiled._table, dx)
        peers.repeat_slope(1, x, p, dx)
        ours, _ = best(repeat, code, turns, x, values, compiled._table, dx)
        hand, _ = best(peers.repeat_slope, turns, x, p, dx)
        print(
            f"| {robots} | {hand / turns * 1e6:.3f} | {ours / turns * 1e6:.3f} | {ours / hand:.2f} | {lowering:.2f} |",
            flush=True,
        )


def compare_runs():
    print("\nOctagon, steel, δ = 2e4, 60 s from formation, accuracy 1e-6 (best of 7)\n")
    print("| by | time (ms) | derivatives | difference (m) |\n| --- | --- | --- | --- |")
    scenario = load_scenario("octagon", overrides={**STIFF, **IN_FORMATION})
    diagram = build_diagram(scenario)
    compiled = lower(diagram)
    context = diagram.CreateDefaultContext()
    start = context.get_continuous_state_vector().CopyToVector()
    p = peers.parameters(scenario)

    def ours():
        context = diagram.CreateDefaultContext()
        pieces = list(compiled.integrate(context, 60.0))
        return pieces[-1].states[-1], sum(piece.evaluations for piece in pieces)

    def hand():
        x, _, evaluations = peers.dormand_prince(start, 60.0, p, 1e-6, 0.1)
        return x, evaluations

    expected, evaluations = hand()
    state, our_evaluations = ours()
    slow, quick = best(hand)[0], best(ours)[0]
    print(f"| hand-written | {slow * 1e3:.2f} | {evaluations} | |")
    print(f"| compiled diagram | {quick * 1e3:.2f} | {our_evaluations} | {np.abs(state - expected).max():.1e} |")
    print(f"\nratio {quick / slow:.2f}")


if __name__ == "__main__":
    compare_derivatives()
    compare_runs()
