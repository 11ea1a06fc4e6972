"""The transport phase of a run, as metrics look at it: between its samples too."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.measuring.control_law import ControlLaw, RecordedForces, StagedLaw, control_law
from drake_formation.measuring.traffic import Traffic, traffic
from drake_formation.scenario import resolve
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.series import Series

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Transport:
    """A run from the hand-off to its end.

    Attributes:
        series: the whole run: arrays by the names of the labelled result's variables.

    Raises:
        ValueError: the run ends before the transport begins.
    """

    series: Series

    def __post_init__(self) -> None:
        if not self._samples.any():
            raise ValueError("the result has no transport phase to measure")

    def __getitem__(self, name: str) -> Array:
        """A variable over time at the samples of the transport phase, in its unit; time is its first axis."""
        return self.series[name][self._samples]

    @cached_property
    def formation(self) -> Formation:
        """What ran."""
        return resolve(self.series.scenario)

    @cached_property
    def robots(self) -> Motion:
        """The robots' motion; where forces jump with an update, so do accelerations."""
        motion = self._motion("position", "velocity", "acceleration")
        jumps = self.step_begins - self["control_force"][:-1]
        if not jumps.any():
            return motion
        return replace(motion, leaving=motion.acceleration[:-1] + jumps / self.formation.masses[:, None])

    @cached_property
    def bulge(self) -> Array:
        """How far each robot leaves the chord of each step at the most (m), shape (samples − 1, robots)."""
        return self.robots.bulge()

    @cached_property
    def deviation(self) -> Motion:
        """The motion relative to the obstacle-free response."""
        return self._motion("deviation", "deviation_velocity", "deviation_acceleration")

    @cached_property
    def law(self) -> ControlLaw | StagedLaw | RecordedForces:
        """The control forces as a function of time and state."""
        return control_law(self.formation, self["time"], self["control_force"])

    @cached_property
    def step_begins(self) -> Array:
        """Control forces (N) with which every step begins, shape (samples − 1, N, 2); it ends with those recorded."""
        begins: Array = self.law.begins if isinstance(self.law, RecordedForces) else self["control_force"][:-1]
        return begins

    @cached_property
    def half_way(self) -> tuple[Array, Array]:
        """Control forces (N) and velocities (m/s) half-way through every step, each of shape (samples − 1, N, 2)."""
        times = self.robots.times
        steps = np.arange(len(times) - 1)
        position, velocity, _ = self.robots.at(steps, np.full((len(steps), 1), 0.5))
        return self.law(0.5 * (times[:-1] + times[1:]), position[:, 0], velocity[:, 0]), velocity[:, 0]

    @cached_property
    def packets(self) -> Traffic | None:
        """What became of packets; None where nobody listens to a channel that carries some, or there is one sample."""
        if "traffic" not in self.series or len(self["time"]) < 2:
            return None
        channels = self.formation.channels.labels
        parts = dict(zip(channels, self.formation.parts["channel"], strict=True))
        sizes = np.array([parts[str(label)].config.bits for label in self.series["channel"]])
        return traffic(self["time"], self["traffic"], sizes)

    @cached_property
    def _samples(self) -> NDArray[np.bool_]:
        samples: NDArray[np.bool_] = self.series["phase"] == 1
        return samples

    def _motion(self, *names: str) -> Motion:
        return Motion(self["time"], *(self[name] for name in names))
