"""What the compiled diagram costs beside the same formation written by hand in numba: ``make bench``."""

import statistics
import time

import numpy as np
import peers
from formations import polygon
from numba import njit

from drake_formation import build_diagram
from drake_formation.lowering import lower


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


if __name__ == "__main__":
    compare_derivatives()
