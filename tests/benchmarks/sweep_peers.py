"""64 runs over (k, δ) beside diffrax's vmap, heyoka and CasADi, on the same processors: ``make bench``.

Each run is 60 s of transport from formation, its states wanted at every second, positions within 1e-4 m. A sweep of
this project does more (metrics, the obstacle-free response, a database and a dataset), which is measured beside it.
"""

import os
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import sweeps
from formations import IN_FORMATION

from drake_formation import build_diagram, load_scenario, with_overrides
from drake_formation.lowering import lower
from drake_formation.parameters import block_parameters, write_parameters
from drake_formation.scenario import resolve
from drake_formation.sweep import Processes

SECONDS = np.arange(1.0, 61.0)
STIFFNESSES, DELTAS = (
    axis.ravel() for axis in np.meshgrid(np.geomspace(1.45, 3e4, 8), np.linspace(0.0, 2e4, 8), indexing="ij")
)
REPEATS = 5


class Runs:
    """Runs of one scenario with other gains, in one process."""

    ready: "Runs"

    def __init__(self, name):
        self.scenario = load_scenario(name, overrides=IN_FORMATION)
        self.diagram = build_diagram(self.scenario)
        self.compiled = lower(self.diagram)
        self.context = self.diagram.CreateDefaultContext()

    def states(self, stiffness, delta, **options):
        """States at every second, shape (60, 4N)."""
        scenario = with_overrides(
            self.scenario, {"springs.stiffness": float(stiffness), "consensus.delta": float(delta)}
        )
        self.context.SetTime(0.0)
        self.diagram.SetDefaultContext(self.context)
        write_parameters(self.diagram, self.context, block_parameters(resolve(scenario)))
        pieces = self.compiled.integrate(self.context, 60.0, at=SECONDS, **options)
        return np.concatenate([piece.states for piece in pieces])

    @staticmethod
    def prepare(name):
        Runs.ready = Runs(name)

    @staticmethod
    def chunk(gains, options):
        return [Runs.ready.states(*each, **options) for each in gains]


def best(function):
    """What a function gives, and the least wall time of some calls (s)."""
    function()
    spent = []
    for _ in range(REPEATS):
        begin = time.perf_counter()
        result = function()
        spent.append(time.perf_counter() - begin)
    return result, min(spent)


def compare(name, robots, processors):
    import diffrax_peer
    import symbolic_peers

    runs, gains = Runs(name), list(zip(STIFFNESSES, DELTAS, strict=True))
    start = runs.diagram.CreateDefaultContext().get_continuous_state_vector().CopyToVector()
    exact = np.array([runs.states(*each, accuracy=1e-11, max_step=0.02) for each in gains])

    def row(title, states, spent, baseline):
        error = "" if states is None else f"{np.abs(states - exact).reshape(64, 60, -1, 4)[..., :2].max():.1e}"
        print(f"| {robots} | {title} | {64 / spent:.0f} | {baseline / spent:.1f} | {error} |", flush=True)

    peer = {
        parts: best(diffrax_peer.many(runs.scenario, start, 60, 1e-6, STIFFNESSES, DELTAS, parts))
        for parts in (1, processors, 2 * processors, 8 * processors)
    }
    states, baseline = min(peer.values(), key=lambda found: found[1])
    row("diffrax + vmap", states, baseline, baseline)
    one = (runs.scenario, start, 60, STIFFNESSES, DELTAS)
    row("heyoka, ensemble", *best(symbolic_peers.heyoka_many(*one)), baseline)
    row("CasADi, CVODES, threads", *best(symbolic_peers.casadi_many(*one, processors)), baseline)
    chunks = [gains[k :: 4 * processors] for k in range(4 * processors)]
    order = np.argsort(np.concatenate([np.arange(64)[k :: 4 * processors] for k in range(4 * processors)]))
    with ProcessPoolExecutor(
        processors, mp_context=get_context("spawn"), initializer=Runs.prepare, initargs=(name,)
    ) as pool:
        for title, options in (
            ("states, `compiled`", {"method": "dormand_prince"}),
            ("states, `exponential`", {"method": "exponential", "max_step": 0.5}),
        ):
            found, spent = best(lambda options=options: list(pool.map(Runs.chunk, chunks, [options] * len(chunks))))
            row(title, np.concatenate(found)[order], spent, baseline)
    with Processes(processors) as workers:
        sweep = sweeps.gains(name)
        for engine in ("compiled", "exponential"):
            _, spent = best(lambda engine=engine: sweeps.seconds(sweep, workers, engine))
            row(f"a whole sweep, `{engine}`", None, spent, baseline)


def main():
    processors = len(os.sched_getaffinity(0))
    print(f"64 runs over (k, δ), 60 s from formation, on {processors} processors, once warm\n")
    print("| robots | by | runs/s | of diffrax | error (m) |\n| --- | --- | --- | --- | --- |")
    for name, robots in (("quadrilateral", 4), ("octagon", 8)):
        compare(name, robots, processors)


if __name__ == "__main__":
    main()
