"""How long a new process takes until it has a compiled right-hand side, cold and from the cache: ``make bench``."""

import itertools
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

REPEATS = 5


def first_use(robots):
    """Imports, builds and lowers in this process; times in seconds."""
    marks = [time.perf_counter()]

    def mark():
        marks.append(time.perf_counter())

    from pydrake.systems import analysis, controllers, framework, primitives  # noqa: F401

    mark()
    from formations import polygon

    from drake_formation import build_diagram

    diagram = build_diagram(polygon(robots))
    mark()
    from drake_formation.lowering import lower

    compiled = lower(diagram)
    context = diagram.CreateDefaultContext()
    compiled.derivatives(0.0, context.get_continuous_state_vector().CopyToVector(), compiled.read(context))
    mark()
    for _ in compiled.integrate(context, 1e-3):
        pass
    mark()
    drake, build, compile_, integrate = (b - a for a, b in itertools.pairwise(marks))
    return {"drake": drake, "build": build, "lower": compile_, "integrate": integrate}


def elsewhere(robots, folder):
    """The same in a new process that keeps its code in a folder."""
    environment = os.environ | {"DRAKE_FORMATION_CACHE_DIR": str(folder)}
    command = [sys.executable, __file__, str(robots)]
    return json.loads(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)


def compare():
    print("A new process: importing Drake, importing and building, `lower()`, a first integration (s)\n")
    print("| robots | code | Drake | build | lower | integrate | beyond Drake |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for robots in (8, 30, 100):
        with tempfile.TemporaryDirectory() as folder:
            cold = [elsewhere(robots, Path(folder) / str(k)) for k in range(2)]
            warm = [elsewhere(robots, Path(folder) / "0") for _ in range(REPEATS)]
        for title, found in (("cold", cold), ("from the cache", warm)):
            times = {part: statistics.median(each[part] for each in found) for part in found[0]}
            beyond = min(sum(each.values()) - each["drake"] for each in found)
            cells = " | ".join(f"{value:.2f}" for value in [*times.values(), beyond])
            print(f"| {robots} | {title} | {cells} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(first_use(int(sys.argv[1]))))
    else:
        compare()
