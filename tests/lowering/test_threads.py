"""Compiled runs from many threads at once, the first use of all included."""

import subprocess
import sys

import pytest

PROGRAM = """
import threading

import numpy as np

from drake_formation import load_scenario, simulate

short = {"transport.duration": 2.0, "aggregation.duration": 1.0}
scenarios = [load_scenario(name, overrides=short) for name in ("line", "line", "line", "quadrilateral", "line")]
engines = ["compiled", "compiled", "exponential", "compiled", "blocks"]
found, failed = {}, []
together = threading.Barrier(len(scenarios))


def run(k):
    together.wait()
    try:
        found[k] = simulate(scenarios[k], engine=engines[k])["position"].values
    except BaseException as error:
        failed.append(error)


threads = [threading.Thread(target=run, args=(k,)) for k in range(len(scenarios))]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert not failed, failed
for k, (scenario, engine) in enumerate(zip(scenarios, engines)):
    np.testing.assert_array_equal(found[k], simulate(scenario, engine=engine)["position"].values)
print("alike")
"""


@pytest.mark.slow
def test_threads_that_compile_for_the_first_time_together_run_as_if_alone(tmp_path, monkeypatch):
    monkeypatch.setenv("DRAKE_FORMATION_CACHE_DIR", str(tmp_path / "cache"))
    result = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=False)
    assert result.stdout == "alike\n", result.stderr
