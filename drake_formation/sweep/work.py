"""What is sent to a worker and what comes back: numbered points out, arrays in."""

import functools
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.metadata import version
from platform import python_version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.lowering.errors import LoweringError
from drake_formation.scenario import ScenarioError
from drake_formation.scenario.source import Document
from drake_formation.simulation import SimulationError
from drake_formation.sources import guest_hashes, source_hash
from drake_formation.sweep.definition import point_scenario
from drake_formation.sweep.errors import SweepError
from drake_formation.sweep.runner import Runner
from drake_formation.sweep.schema import Trajectories

Array = NDArray[np.float64]

CODE = "drake-formation-code"
"""Name under which the hash of this package's sources stands among the versions."""


@dataclass(frozen=True)
class Task:
    """What all runs of a sweep have in common.

    Attributes:
        base: data of the base scenario.
        engine: ``blocks`` or ``compiled``.
        trajectories: time series to keep.
        versions: of the software that makes the runs.
    """

    base: dict[str, Any]
    engine: str
    trajectories: Trajectories | None
    versions: Mapping[str, str]


@dataclass(frozen=True)
class Chunk:
    """Points to run one after another.

    Attributes:
        task: what they have in common.
        points: number of each point, and what it sets in the base scenario.
        retried: whether a worker died over them before.
    """

    task: Task
    points: tuple[tuple[int, dict[str, Any]], ...]
    retried: bool = False


@dataclass(frozen=True)
class Outcome:
    """What came out of one run.

    Attributes:
        index: number of the point.
        error: why the run failed; None if it did not.
        values: metrics and time series by name; metrics that do not exist are NaN.
    """

    index: int
    error: str | None
    values: dict[str, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class Report:
    """What comes back for a chunk.

    Attributes:
        outcomes: of each point.
        seconds: how long it took.
        built: diagrams that this process has built since it began.
    """

    outcomes: list[Outcome]
    seconds: float
    built: int


@functools.cache
def versions() -> dict[str, str]:
    """Versions of all software whose numbers end up in a result.

    Of what may be worked on, this package and others that bring parts or metrics, it is the code that counts.
    """
    packages = {name: version(name) for name in ("drake-formation", "drake", "numpy", "scipy", "numba")}
    guests = {f"{name} code": its[:16] for name, its in guest_hashes().items()}
    return {"python": python_version(), CODE: source_hash()[:16]} | packages | guests


def run_chunk(chunk: Chunk) -> Report:
    """Run a chunk in this process.

    Raises:
        SweepError: this process has other software than the one that sent the chunk.
    """
    if different := {name for name, its in chunk.task.versions.items() if versions().get(name) != its}:
        theirs = ", ".join(f"{name} {versions().get(name)}" for name in sorted(different))
        ours = ", ".join(f"{name} {chunk.task.versions[name]}" for name in sorted(different))
        raise SweepError(f"a worker has {theirs} where this process has {ours}; their results would differ")
    with _ONE_AT_A_TIME:
        begin = time.perf_counter()
        runner = _runner(chunk.task.engine, chunk.task.trajectories)
        base = Document(f"scenario {chunk.task.base.get('name')!r}", chunk.task.base)
        outcomes = [_run(runner, base, index, overrides) for index, overrides in chunk.points]
        return Report(outcomes, time.perf_counter() - begin, runner.built)


_ONE_AT_A_TIME = threading.Lock()
"""Dask's workers may have several threads; a runner serves one."""


@functools.lru_cache(maxsize=4)
def _runner(engine: str, trajectories: Trajectories | None) -> Runner:
    return Runner(engine, trajectories)


def _run(runner: Runner, base: Document, index: int, overrides: dict[str, Any]) -> Outcome:
    try:
        return Outcome(index, None, runner.measure(point_scenario(base, overrides)))
    except (ScenarioError, SimulationError, LoweringError) as error:
        reason = str(error)
    except (Exception, SystemExit) as error:  # whatever it is, it is this run's, and the sweep goes on
        reason = f"{type(error).__name__}: {error}"
    return Outcome(index, reason.replace("\0", "").encode(errors="backslashreplace").decode())
