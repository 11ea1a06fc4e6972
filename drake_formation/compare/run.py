"""Running a comparison, one process a processor where others know its parts."""

from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drake_formation.compare.comparison import Comparison, Run
from drake_formation.measuring.metric import Value
from drake_formation.sources import SESSION
from drake_formation.vectors import length

if TYPE_CHECKING:
    import xarray as xr

KEPT = 400
"""Spans of a run of which figures keep one sample each, that with the largest consensus error."""
SHOWN = ("position", "consensus_error", "phase", "obstacle_position", "obstacle_radius", "obstacle_outline")
"""What figures show of a run."""


@dataclass(frozen=True)
class Outcome:
    """What came of a run.

    Attributes:
        run: which.
        metrics: its figures by name; empty where it failed.
        failure: why it failed; empty where it did not.
        channels: channels over which a robot hears another, and whose state some law reads.
        messages: messages a second over all of them; infinity where they are heard all the time.
        result: what figures show of it.
    """

    run: Run
    metrics: dict[str, Value]
    failure: str
    channels: int
    messages: float
    result: "xr.Dataset"


def run_comparison(
    comparison: Comparison, *, workers: int | None = None, progress: Callable[[int, int], None] | None = None
) -> list[Outcome]:
    """Run a comparison; a run that fails is an outcome too.

    Where a part was registered in this session, as a notebook does, all is run in this process: no other knows it.

    Args:
        comparison: from :func:`drake_formation.compare.load_comparison`.
        workers: number of processes; that of processors if not given.
        progress: called with the runs that are done and all there are.

    Returns:
        The outcomes in the order of the comparison's runs.
    """
    tell = progress or (lambda _done, _total: None)
    here = any(is_of_this_session(run) for run in comparison.runs)
    return _run_here(comparison, tell) if here else _run_in_processes(comparison, workers, tell)


def is_of_this_session(run: Run) -> bool:
    """Whether a part of a run was registered in this session."""
    from drake_formation.scenario import resolve

    return any(part.distribution == SESSION for parts in resolve(run.scenario).parts.values() for part in parts)


def _run_here(comparison: Comparison, tell: Callable[[int, int], None]) -> list[Outcome]:
    outcomes: list[Outcome] = []
    tell(0, len(comparison.runs))
    for run in comparison.runs:
        outcomes.append(run_one(run))
        tell(len(outcomes), len(comparison.runs))
    return outcomes


def _run_in_processes(comparison: Comparison, workers: int | None, tell: Callable[[int, int], None]) -> list[Outcome]:
    from drake_formation.sweep.executors import processors
    from drake_formation.sweep.processes import Processes

    total = len(comparison.runs)
    workers = min(workers or processors(), total)
    with Processes(workers) as processes:
        futures: list[Future[Outcome]] = [processes.call(run_one, run) for run in comparison.runs]
        pending: set[Future[Outcome]] = set(futures)
        while pending:
            tell(total - len(pending), total)
            _, pending = wait(pending, timeout=0.5, return_when=FIRST_COMPLETED)
        return [future.result() for future in futures]


def run_one(run: Run) -> Outcome:
    """Run one scenario of a comparison, by the engine that is the fastest for it."""
    from drake_formation.measuring import metrics
    from drake_formation.simulation import SimulationError, simulate

    failure, figures = "", dict[str, Value]()
    try:
        result = simulate(run.scenario)
    except SimulationError as error:
        result, failure = error.partial, str(error)
    try:
        figures = {} if failure else metrics(result).to_dict()
    except ValueError as error:  # a run too short to be measured
        failure = str(error)
    channels, messages = traffic(run)
    return Outcome(run, figures, failure, channels, messages, shown(result))


def traffic(run: Run) -> tuple[int, float]:
    """Channels that some law reads, and messages a second over them: as often as packets are sent, or a law reads."""
    from drake_formation.robot_diagram import robot_diagram
    from drake_formation.scenario import resolve

    formation = resolve(run.scenario)
    channels, messages = 0, 0.0
    pairs = formation.channels.pairs.tolist()
    for robot in range(formation.robots):
        diagram = robot_diagram(formation, robot)
        read = getattr(formation.parts["coordination"][robot].config, "period", None)
        for (listener, speaker), channel in zip(pairs, formation.parts["channel"], strict=True):
            if listener == robot and diagram.HasInputPort(f"channel_{speaker + 1}"):
                channels += 1
                messages += _rate(channel.network.period if getattr(channel, "tells_traffic", False) else read)
    return channels, messages


def _rate(period: float | None) -> float:
    return 1.0 / period if period else np.inf


def shown(result: "xr.Dataset") -> "xr.Dataset":
    """What figures show of a run, at the first and the last of its samples and some between."""
    error = length(result["consensus_error"]).max("robot").values
    spans = np.array_split(np.arange(len(error)), min(len(error), KEPT))
    peaks = [int(span[np.argmax(error[span])]) for span in spans]
    chosen = sorted({0, *peaks, len(error) - 1})
    return result[[name for name in SHOWN if name in result]].isel(time=chosen).load()
