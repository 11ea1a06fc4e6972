"""How far a run is from the true solution, by a second and more accurate one.

``simulator.accuracy`` bounds what the integrator estimates that it errs by in one step. What becomes of those errors in
the course of a run is up to the scenario: most formations make them smaller, some a thousand times larger.
"""

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from drake_formation.measuring import metrics
from drake_formation.measuring.metric import Metrics, Value
from drake_formation.scenario import Scenario
from drake_formation.simulation.extremes import Vectors, longest
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.phases import Progress
from drake_formation.simulation.result import series_of
from drake_formation.simulation.run import simulate
from drake_formation.simulation.series import Series

if TYPE_CHECKING:
    import xarray as xr

MORE_ACCURATE, SHORTER = 100.0, 4.0
"""How many times the second run is more accurate and its longest step shorter."""
FINEST = 1e-12
"""The accuracy below which a second run does not go: rounding would make its steps too small."""


@dataclass(frozen=True, kw_only=True)
class Check:
    """What a second, more accurate run says about a run.

    Attributes:
        accuracy: the second run's ``simulator.accuracy``.
        max_step_size: its ``simulator.max_step_size`` (s).
        engine: what ran it.
        position_difference_m: largest distance between the two runs' positions of any robot at any time (m).
        metrics: how far each metric is from the second run's, in its unit; None where one of the runs has none.
    """

    accuracy: float
    max_step_size: float
    engine: str
    position_difference_m: float
    metrics: dict[str, float | list[float] | None]

    def to_dict(self) -> dict[str, Any]:
        """Everything by name."""
        return asdict(self)


def check(scenario: Scenario, result: "xr.Dataset", *, progress: Progress | None = None) -> Check:
    """Run a scenario once more, a hundred times as accurate and with steps a quarter as long at the most, and compare.

    The second run is by the engine that is the fastest for it, which need not be that of the first.

    Args:
        scenario: what ran.
        result: what came out.
        progress: called as the simulated time goes on.

    Raises:
        ScenarioError: the scenario is wrong.
        SimulationError: the second run could not go on.
        ValueError: the result is not one of this version.
    """
    finer = tightened(scenario)
    second = simulate(finer, progress=progress)
    ours, theirs = metrics(result), metrics(second)
    return Check(
        accuracy=finer.simulator.accuracy,
        max_step_size=finer.simulator.max_step_size,
        engine=second.attrs["engine"],
        position_difference_m=position_difference(series_of(result), series_of(second)),
        metrics=differences(ours, theirs),
    )


def tightened(scenario: Scenario) -> Scenario:
    """The scenario with a finer accuracy and shorter steps."""
    settings = scenario.simulator
    finer = {
        "accuracy": min(settings.accuracy, max(settings.accuracy / MORE_ACCURATE, FINEST)),
        "max_step_size": settings.max_step_size / SHORTER,
    }
    return scenario.model_copy(update={"simulator": settings.model_copy(update=finer)})


def position_difference(first: Series, second: Series) -> float:
    """Largest distance between two runs' positions of any robot at any time that both recorded (m)."""
    largest = [0.0]
    for phase in (0, 1):  # each by itself: accelerations jump in between
        motions = [_motion(series, phase) for series in (first, second)]
        if all(len(motion.times) for motion in motions):
            apart = _difference(*motions)
            largest += longest(Vectors.of_positions(apart, apart.bulge())).tolist()
    return max(largest)


def differences(ours: Metrics, theirs: Metrics) -> dict[str, Value]:
    """By how much each metric differs; None where one is None."""
    return {name: _apart(value, theirs[name]) for name, value in ours.items()}


def _apart(first: Value, second: Value) -> Value:
    if first is None or second is None:
        return None
    distance: Value = np.abs(np.subtract(first, second)).tolist()
    return distance


def _motion(series: Series, phase: int) -> Motion:
    chosen = series["phase"] == phase
    return Motion(series["time"][chosen], *(series[name][chosen] for name in ("position", "velocity", "acceleration")))


def _difference(first: Motion, second: Motion) -> Motion:
    """The motion of one relative to the other, while both go on, at the samples of either."""
    times = np.union1d(first.times, second.times)
    begin, end = max(first.times[0], second.times[0]), min(first.times[-1], second.times[-1])
    times = times[(times >= begin) & (times <= end)]
    return Motion(times, *(a - b for a, b in zip(first.at_times(times), second.at_times(times), strict=True)))
