"""How many runs a second a sweep makes, and whether its memory stays flat: ``make bench``.

Workers are started, and their code is loaded, before the clock starts; everything else of a sweep is in the times:
handing out, running, measuring, keeping on disk, and the dataset.
"""

import os
import sys
import tempfile
import time
from pathlib import Path

from formations import IN_FORMATION

from drake_formation.sweep import Processes, load_sweep, run_sweep
from drake_formation.sweep.store import DATABASE

REPEATS = 5


def gains(scenario, count=8):
    """Stiffness against consensus gain, 60 s of transport from formation."""
    axes = [
        {"path": "springs.stiffness", "logspace": [1.45, 3e4, count]},
        {"path": "consensus.delta", "linspace": [0.0, 2e4, count]},
    ]
    return load_sweep({"name": "gains", "scenario": scenario, "set": IN_FORMATION, "axes": axes})


def seconds(sweep, executor, engine="compiled"):
    """Wall time of a sweep into a new folder (s)."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.perf_counter()
        run_sweep(sweep, folder, engine=engine, executor=executor, figures=False).close()
        return time.perf_counter() - begin


def compare_rates():
    processors = len(os.sched_getaffinity(0))
    print("Runs a second of the 64-run sweep over (k, δ), 60 s of transport from formation, best of 5\n")
    print(f"| robots | one process | {processors} processes |\n| --- | --- | --- |")
    with Processes(processors) as workers:
        for scenario, robots in (("quadrilateral", 4), ("octagon", 8)):
            sweep = gains(scenario)
            rates = []
            for executor in ("serial", workers):
                seconds(sweep, executor)
                rates.append(len(sweep) / min(seconds(sweep, executor) for _ in range(REPEATS)))
            print(f"| {robots} | {rates[0]:.0f} | {rates[1]:.0f} |", flush=True)


def resident(pid):
    """Memory of a process (MB), as Linux counts it."""
    status = Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    return next(int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith("VmRSS"))


def watch_memory(runs):
    """A long sweep of short runs, with metrics alone."""
    draw = {"springs.stiffness": {"loguniform": [1.0, 1e3]}, "consensus.delta": {"uniform": [0.0, 1e3]}}
    axes = [{"kind": "random", "seed": 1, "count": runs, "draw": draw}]
    settings = IN_FORMATION | {"transport.duration": 10.0}
    sweep = load_sweep({"name": "memory", "scenario": "line", "set": settings, "axes": axes})
    print(f"\nMemory of a sweep of {runs} runs (MB)\n")
    print("| finished | this process | each worker | runs/s |\n| --- | --- | --- | --- |")
    marks = [0.1, 0.25, 0.5, 0.75, 1.0]
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder, Processes(2) as workers:

        def watch(tally):
            if marks and tally.finished >= marks[0] * tally.total:
                marks.pop(0)
                each = ", ".join(f"{resident(pid):.0f}" for pid in sorted(workers.pids))
                rate = tally.finished / (time.perf_counter() - begin)
                print(f"| {tally.finished} | {resident(os.getpid()):.0f} | {each} | {rate:.0f} |", flush=True)

        run_sweep(sweep, folder, executor=workers, figures=False, progress=watch).close()
        database, dataset = ((Path(folder) / name).stat().st_size / 1e6 for name in (DATABASE, "sweep.nc"))
        print(f"\nOn disk: {database:.1f} MB of runs, {dataset:.1f} MB of dataset")


if __name__ == "__main__":
    compare_rates()
    watch_memory(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
