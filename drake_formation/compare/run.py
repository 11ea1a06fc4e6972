"""Running a comparison, one process a processor where others know its parts."""

from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.compare.comparison import Comparison, Run
from drake_formation.measuring.metric import Value
from drake_formation.sources import SESSION

Array = NDArray[np.float64]

KEPT = 400
"""Samples of a run that figures are drawn of, at the most."""


@dataclass(frozen=True)
class Outcome:
    """What came of a run.

    Attributes:
        run: which.
        metrics: its figures by name; empty where it failed.
        failure: why it failed; empty where it did not.
        channels: channels over which a robot hears another, and whose state some law reads.
        messages: messages a second over all of them; infinity where they are heard all the time.
        times: sample times (s), shape (samples,).
        position: of the robots (m), shape (samples, N, 2).
        consensus_error: largest of any robot (m), shape (samples,).
        carried: whether the object was carried, shape (samples,).
    """

    run: Run
    metrics: dict[str, Value]
    failure: str
    channels: int
    messages: float
    times: Array
    position: Array
    consensus_error: Array
    carried: NDArray[np.bool_]


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
    from drake_formation.vectors import length_of

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
    chosen = _thinned(len(result["time"]))
    return Outcome(
        run, figures, failure, channels, messages,
        result["time"].values[chosen],
        result["position"].values[chosen],
        length_of(result["consensus_error"].values[chosen]).max(axis=1),
        result["phase"].values[chosen] == 1,
    )  # fmt: skip


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


def _thinned(samples: int) -> NDArray[np.intp]:
    return np.unique(np.linspace(0, max(samples - 1, 0), min(samples, KEPT)).astype(np.intp))
