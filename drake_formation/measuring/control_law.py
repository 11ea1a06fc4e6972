"""The control forces on all robots along a motion, by the laws of the blocks, many times at once."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.formation.names import robot_name
from drake_formation.parameters import block_parameters
from drake_formation.parts.actuators.ideal import IdealActuator
from drake_formation.parts.actuators.motor import MotorActuator
from drake_formation.parts.avoidance.khatib import Khatib, avoidance_force
from drake_formation.parts.computers.continuous import ContinuousComputer
from drake_formation.parts.coordination.consensus import LAWS, Consensus
from drake_formation.parts.part import Part
from drake_formation.parts.references.set_point import SetPointReference
from drake_formation.parts.references.trajectory import Motion as MovingReference
from drake_formation.parts.references.trajectory import polynomial_motion
from drake_formation.parts.sensors.ideal import IdealSensor
from drake_formation.parts.tracking.lqr import Lqr, feed_forward_force, tracking_force
from drake_formation.systems.sensing import nearest

Array = NDArray[np.float64]
Law = Callable[[Array, Array, Array], Array]
"""Control forces (N), shape (..., N, 2), of times (s), shape (...), positions (m) and velocities (m/s), (..., N, 2)."""

KNOWN: dict[str, tuple[type[Part], ...]] = {
    "tracking": (Lqr,),
    "coordination": (Consensus,),
    "avoidance": (Khatib,),
    "reference": (SetPointReference, MovingReference),
    "sensor": (IdealSensor,),
    "computer": (ContinuousComputer,),
    "actuator": (IdealActuator,),
}
"""The parts whose laws are here; all are functions of time and the robots' states alone."""

BLOCKS = ("tracking", "consensus", "avoidance")
"""The blocks of a robot whose forces add up to its control."""


def control_law(formation: Formation, times: Array, recorded: Array) -> "ControlLaw | StagedLaw | RecordedForces":
    """The control u of every robot during transport (paper, Eq. 8), as a function of time and state.

    Where a robot has parts of other kinds, which may have states of their own, where robots remember what they sense,
    keep away from each other or have footprints, or where obstacles are no circles or move, it is read off what was
    recorded.

    Args:
        formation: what ran.
        times: when it was recorded (s), shape (m,).
        recorded: the control forces that acted on the robots then (N), shape (m, N, 2).
    """
    known = all(isinstance(part, kinds) for role, kinds in KNOWN.items() for part in formation.parts[role])
    simple = known and formation.over_wires and not formation.footprints.any() and formation.obstacles.are_circles
    if simple and not any(map(_is_more, formation.parts["avoidance"])):
        return StagedLaw(formation) if formation.stages else ControlLaw(formation)
    return RecordedForces(formation, times, recorded)


class RecordedForces:
    """The control as it was recorded: in between on a straight line, but for jumps.

    A sample at the time of an update shows the force until then, the first one that from then on. Where an actuator
    does not smooth the force, a step that begins with an update has the force of its end throughout: all of it for
    forces that are held, and up to what else changes within a step for others.

    Args:
        formation: what ran.
        times: when it was recorded (s), rising, shape (m,).
        recorded: the control forces then (N), shape (m, N, 2).
    """

    def __init__(self, formation: Formation, times: Array, recorded: Array) -> None:
        rough = [not (isinstance(part, MotorActuator) and part.is_smooth) for part in formation.parts["actuator"]]
        jumps = formation.is_updated(times[:-1])
        jumps[:1] = False
        self._times, self._ends = times, recorded[1:]
        self.begins = np.where((jumps[:, None] & rough)[..., None], recorded[1:], recorded[:-1])

    def __call__(self, times: Array, position: Array, _velocity: Array) -> Array:
        """Control forces (N); see :data:`Law`."""
        if not len(self._ends):
            return np.zeros_like(position)
        step = np.clip(np.searchsorted(self._times, times) - 1, 0, len(self._ends) - 1)
        share = (times - self._times[step]) / (self._times[step + 1] - self._times[step])
        force: Array = self.begins[step] + share[..., None, None] * (self._ends - self.begins)[step]
        return force


def _is_more(field: Part) -> bool:
    """Whether a field around obstacles goes by more than where robots and obstacles are."""
    config: Any = field.config
    return bool(getattr(field, "margin", 0.0) or config.robots or config.line_of_sight)


class ControlLaw:
    """The control by parts that are all ``KNOWN``.

    Args:
        formation: the robots' formation.
    """

    def __init__(self, formation: Formation) -> None:
        numbers, robots = block_parameters(formation), range(formation.robots)
        own = {block: [numbers[f"{robot_name(i)}/{block}"] for i in robots] for block in BLOCKS}
        self._gains = [
            np.array(column) for column in zip(*(np.ravel(gain) for gain, *_ in own["tracking"]), strict=True)
        ]
        self._inertia = np.array([inertia[0] for _, inertia, _ in own["tracking"]])
        self._slots = formation.slots
        gains = np.array([group[0] for group in own["consensus"]])
        laws = np.array([part.config.law for part in formation.parts["coordination"]])
        linear = np.where(laws == "linear", gains.T, 0.0)
        self._delta, self._delta_v = (gain[:, None] * formation.channels.laplacian for gain in linear)
        self._channels = formation.channels
        self._others = [
            (law, np.flatnonzero(laws[formation.channels.pairs[:, 0]] == law)) for law in set(laws) - {"linear"}
        ]
        self._consensus_gains = gains
        self._range, self._gain = np.array([group[0] for group in own["avoidance"]]).T
        self._obstacles = formation.obstacles.discs
        fields = formation.parts["avoidance"]
        self._masked = np.array([field.masked for field in fields])
        self._feels = np.array([field.feels(formation, i) for i, field in enumerate(fields)], dtype=float)
        self._reference = numbers["reference"]
        self._set_point = isinstance(formation.parts["reference"][0], SetPointReference)

    def __call__(self, times: Array, position: Array, velocity: Array) -> Array:
        """Control forces (N); see :data:`Law`."""
        return self._tracking(times, position, velocity) + self._consensus(position, velocity) + self._avoid(position)

    def _tracking(self, times: Array, position: Array, velocity: Array) -> Array:
        place, speed, acceleration = self._reference_at(times)
        error = position - place[..., None, :] - self._slots
        drift = velocity - speed[..., None, :]
        back = tracking_force((error[..., 0], error[..., 1], drift[..., 0], drift[..., 1]), self._gains)
        ahead = feed_forward_force(self._inertia, acceleration[..., :1], acceleration[..., 1:])
        force: Array = np.stack(back, axis=-1) + np.stack(ahead, axis=-1)
        return force

    def _reference_at(self, times: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration of the formation centre's reference, each of shape (..., 2)."""
        if self._set_point:
            _, goal = self._reference
            rest = np.zeros((*np.shape(times), 2))
            return rest + goal, rest, rest
        starts, coefficients = self._reference
        piece = np.maximum(np.searchsorted(starts, times, "right") - 1, 0)
        rising = list(np.moveaxis(coefficients[piece], -1, 0))
        return polynomial_motion((times - starts[piece])[..., None], rising)

    def _consensus(self, position: Array, velocity: Array) -> Array:
        """The virtual springs and dampers of all channels; linear ones by the Laplacian (paper, Eqs. 15 to 17)."""
        force: Array = -(self._delta @ (position - self._slots)) - self._delta_v @ velocity
        for law, channels in self._others:
            force += self._drawn(position, velocity, law, channels)
        return force

    def _drawn(self, position: Array, velocity: Array, law: str, channels: NDArray[np.intp]) -> Array:
        """What is heard over some channels, of one law, exerts."""
        i, j = self._channels.pairs[channels].T
        apart, drift = position[..., i, :] - position[..., j, :], velocity[..., i, :] - velocity[..., j, :]
        wanted = self._slots[i] - self._slots[j]
        delta, delta_v = self._consensus_gains[i].T
        force = LAWS[law](
            apart[..., 0], apart[..., 1], drift[..., 0], drift[..., 1], delta, delta_v, wanted[:, 0], wanted[:, 1]
        )
        gathered = self._channels.weights[channels, None] * np.eye(self._channels.robots)[i]
        return np.stack([x @ gathered for x in force], axis=-1)

    def _avoid(self, position: Array) -> Array:
        """The sum of what the sensed obstacles exert."""
        result = np.zeros_like(position)
        for (x, y, radius), feels in zip(self._obstacles, self._feels.T, strict=True):
            dx, dy = position[..., 0] - x, position[..., 1] - y
            with np.errstate(divide="ignore", invalid="ignore"):  # in its middle, where no run goes on
                force = np.stack(avoidance_force(dx, dy, radius, self._range, self._gain), axis=-1)
            result += (feels * self._sensed(dx * dx + dy * dy))[..., None] * force
        return result

    def _sensed(self, squared_distances: Array) -> Array:
        """1 for each robot that is allowed to see an obstacle, else 0; shape (..., N)."""
        if not self._masked.any():
            return np.ones_like(squared_distances)
        columns = list(np.moveaxis(squared_distances, -1, 0))
        seen = np.stack([nearest(columns, i) for i in range(len(columns))], axis=-1)
        return np.where(self._masked, seen, 1.0)


class StagedLaw:
    """The control by such parts where robots fail: zero where its drives have, and in each stage as the others respond.

    Args:
        formation: the robots' formation.
    """

    def __init__(self, formation: Formation) -> None:
        self._begins = [stage.time for stage in formation.stages]
        self._laws = []
        for stage in formation.stages:
            channels = formation.channels
            weights = channels.weights * stage.heeded[channels.pairs].prod(axis=1)
            changes = {"slots": stage.slots, "channels": replace(channels, weights=weights), "stages": ()}
            self._laws.append((ControlLaw(formation.changed(**changes)), stage.drive))

    def __call__(self, times: Array, position: Array, velocity: Array) -> Array:
        """Control forces (N); see :data:`Law`."""
        result, reached = np.empty_like(position), np.searchsorted(self._begins, times, "right") - 1
        for k, (law, drive) in enumerate(self._laws):
            now = reached == k
            result[now] = law(times[now], position[now], velocity[now]) * drive[:, None]
        return result
