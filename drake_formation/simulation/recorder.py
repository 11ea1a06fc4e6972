"""What a run leaves behind, sample by sample, at every step the integrator takes."""

import re
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import Context, Diagram, EventStatus

from drake_formation.diagram import NODES, OBJECT_OUTPUTS
from drake_formation.failing import BROKEN_OUTPUTS, DRIVEN
from drake_formation.formation.names import robot_name
from drake_formation.robot_diagram import DEMANDED, MEASURED, ROBOT_OPTIONS

Array = NDArray[np.float64]

RECORDED = ("state", "tracking_error", "tracking_force", "consensus_force", "avoidance_force", "spring_force")
"""Output ports of every robot that a run records; the rest follows from them and from ``ROBOT_OPTIONS``."""

IN_PLACE_OF = {DEMANDED: "control_force", MEASURED: "state"}
"""Ports that some robots have, and which port of the others tells the same; recorded of all where any has it."""

OBJECT = tuple(f"object_{name}" for name in OBJECT_OUTPUTS)
"""Output ports of an object that is a body of its own, which are recorded as those of one robot are."""

OBJECT_NODES = f"object_{NODES}"
"""Likewise, of an object that is a grid."""


TRAFFIC_PORT = re.compile(r"channel_(\d+)_to_(\d+)_traffic")
"""An output port of channels that carry packets, by the numbers of speaker and listener."""


FARTHEST = 1e12
"""Where error control gives up (m, m/s); it would take ever shorter steps there, for an accuracy that is rounding."""


class NonFiniteStateError(ArithmeticError):
    """A robot's state is no longer finite."""


class BeyondBoundsError(ArithmeticError):
    """A robot's state is beyond where error control can follow it."""


class Recording(Protocol):
    """What was recorded, by whichever engine."""

    @property
    def times(self) -> Array:
        """Sample times (s), shape (samples,)."""

    @property
    def phases(self) -> Array:
        """0 during aggregation, 1 during transport; shape (samples,)."""

    @property
    def channels(self) -> list[str]:
        """The channels whose ``traffic`` is recorded, as :attr:`drake_formation.formation.links.Channels.labels`."""

    def series(self, port: str) -> Array:
        """Values of a recorded port, shape (samples, N, size); N = 1 for those of the whole."""

    def has(self, port: str) -> bool:
        """Whether a port is recorded; not all formations have all."""

    def told(self, port: str) -> dict[int, Array]:
        """Values of one of ``ROBOT_OPTIONS`` by robot that has it, from 0, each of shape (samples, size)."""


def telling(diagram: Diagram, robots: int) -> dict[str, dict[int, str]]:
    """Which of ``ROBOT_OPTIONS`` a formation diagram has: output ports by robot from 0."""
    ports = {option: {i: f"{robot_name(i)}_{option}" for i in range(robots)} for option in ROBOT_OPTIONS}
    return {
        option: {i: name for i, name in its.items() if diagram.HasOutputPort(name)} for option, its in ports.items()
    }


def recorded_ports(diagram: Diagram, robots: int) -> dict[str, list[str]]:
    """What is recorded of a formation diagram: its output ports by what they tell, one a robot or one in all."""
    ports = {name: [f"{robot_name(i)}_{name}" for i in range(robots)] for name in RECORDED}
    ports |= {option: list(its.values()) for option, its in telling(diagram, robots).items() if its}
    if told := told_traffic(diagram):
        ports["traffic"] = list(told.values())
    for name, same in IN_PLACE_OF.items():
        names = [f"{robot_name(i)}_{name}" for i in range(robots)]
        if any(map(diagram.HasOutputPort, names)):
            others = ports[same] = [f"{robot_name(i)}_{same}" for i in range(robots)]
            ports[name] = [
                own if diagram.HasOutputPort(own) else other for own, other in zip(names, others, strict=True)
            ]
    whole = (*OBJECT, OBJECT_NODES, DRIVEN, *BROKEN_OUTPUTS)
    return ports | {name: [name] for name in whole if diagram.HasOutputPort(name)}


def told_traffic(diagram: Diagram) -> dict[str, str]:
    """The output ports at which channels tell what becomes of packets, by channel; unheard ones have none."""
    names = [diagram.get_output_port(k).get_name() for k in range(diagram.num_output_ports())]
    found = [(name, TRAFFIC_PORT.fullmatch(name)) for name in names]
    return {f"{match[1]}-{match[2]}": name for name, match in found if match}


class RecordedPorts:
    """What is recorded of a diagram, and of whom; whoever records gives the ``series``.

    Args:
        diagram: a formation diagram.
        robots: number of robots N.

    Attributes:
        ports: names of the diagram's output ports by what they tell.
        channels: see :class:`Recording`.
    """

    def __init__(self, diagram: Diagram, robots: int) -> None:
        self.ports = recorded_ports(diagram, robots)
        self.channels = list(told_traffic(diagram))
        self._telling = telling(diagram, robots)

    def series(self, port: str) -> Array:
        """Values of a recorded port, shape (samples, N, size)."""
        raise NotImplementedError

    def has(self, port: str) -> bool:
        """Whether a port is recorded."""
        return port in self.ports

    def told(self, port: str) -> dict[int, Array]:
        """Values of one of ``ROBOT_OPTIONS`` by robot that has it, from 0, each of shape (samples, size)."""
        return {robot: self.series(port)[:, k] for k, robot in enumerate(self._telling[port])}


class Recorder(RecordedPorts):
    """A simulator monitor that keeps the recorded ports of every robot and the phase.

    Args:
        diagram: a formation diagram.
        robots: number of robots N.
        progress: called with the simulated time (s) after every step.
        farthest: where to give up (m, m/s).
    """

    def __init__(
        self,
        diagram: Diagram,
        robots: int,
        progress: Callable[[float], None] | None = None,
        farthest: float = np.inf,
    ) -> None:
        super().__init__(diagram, robots)
        self._ports = {name: [diagram.GetOutputPort(port) for port in its] for name, its in self.ports.items()}
        self._phase = diagram.GetOutputPort("phase")
        self._progress, self._farthest = progress, farthest
        self._times: list[float] = []
        self._phases: list[float] = []
        self._samples: dict[str, list[Array]] = {name: [] for name in self._ports}

    def __call__(self, context: Context) -> EventStatus:
        """Keep a sample; one at the time of the last sample replaces it (the hand-off changes forces in no time).

        Raises:
            NonFiniteStateError: a state is infinite or not a number; the sample is not kept.
            BeyondBoundsError: a state is beyond the farthest, and the sample is not kept either.
        """
        time = context.get_time()
        sample = {name: np.array([_shown(port, context) for port in ports]) for name, ports in self._ports.items()}
        if not np.isfinite(sample["state"]).all():
            raise NonFiniteStateError
        if np.abs(sample["state"]).max() > self._farthest:
            raise BeyondBoundsError
        if self._times and self._times[-1] == time:
            self._drop_last()
        self._times.append(time)
        self._phases.append(float(self._phase.Eval(context)[0]))
        for name, value in sample.items():
            self._samples[name].append(value)
        if self._progress:
            self._progress(time)
        return EventStatus.DidNothing()

    def _drop_last(self) -> None:
        self._times.pop()
        self._phases.pop()
        for series in self._samples.values():
            series.pop()

    @property
    def times(self) -> Array:
        """Sample times (s), shape (samples,)."""
        return np.array(self._times)

    @property
    def phases(self) -> Array:
        """0 during aggregation, 1 during transport; shape (samples,)."""
        return np.array(self._phases)

    def series(self, port: str) -> Array:
        """Values of a recorded port, shape (samples, N, size)."""
        ports = self._ports[port]
        return np.reshape(self._samples[port], (len(self._times), len(ports), ports[0].size()))


def _shown(port: Any, context: Context) -> Array:
    """The value of a port; not a number where there is none, as between robots in one place."""
    try:
        shown: Array = port.Eval(context)
    except ZeroDivisionError:
        return np.full(port.size(), np.nan)
    return shown
