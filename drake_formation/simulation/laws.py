"""The forces on all robots along a motion, by the laws of the blocks, many times at once."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation import graphs
from drake_formation.parameters import Parameters, robot_name
from drake_formation.references.trajectory import polynomial_motion
from drake_formation.scenario import Scenario, derive
from drake_formation.systems.avoidance import avoidance_force
from drake_formation.systems.consensus import consensus_force
from drake_formation.systems.plant import SPRING_LAWS
from drake_formation.systems.sensing import nearest
from drake_formation.systems.tracking import feed_forward_force, tracking_force

Array = NDArray[np.float64]


class ControlLaw:
    """The control u of every robot during transport (paper, Eq. 8), as a function of time and state.

    Args:
        scenario: a sound scenario.
        parameters: its numbers, as :func:`drake_formation.parameters.block_parameters` gives them.
    """

    def __init__(self, scenario: Scenario, parameters: Parameters) -> None:
        robots = derive.robot_count(scenario.formation)
        tracking = [parameters[f"{robot_name(i)}/tracking"] for i in range(robots)]
        self._gains = [np.array(column) for column in zip(*(np.ravel(gain) for gain, *_ in tracking), strict=True)]
        self._slots = np.array([slot for _, slot, _ in tracking])
        self._inertia = np.array([inertia[0] for *_, inertia in tracking])
        self._delta, self._delta_v = parameters[f"{robot_name(0)}/consensus"][0]
        (self._range, self._gain), obstacles = parameters[f"{robot_name(0)}/avoidance"]
        self._obstacles = np.reshape(obstacles, (-1, 3))
        self._nearest = scenario.avoidance.sensing == "nearest"
        self._reference = parameters["reference"]
        self._set_point = scenario.transport.reference.kind == "set_point"
        channels = graphs.edges(derive.communication_graph(scenario))
        self._first, self._second = [i for i, _ in channels], [j for _, j in channels]
        ends = np.eye(robots)
        self._incidence = ends[self._first] - ends[self._second]

    def __call__(self, times: Array, position: Array, velocity: Array) -> Array:
        """Control forces (N), shape (..., N, 2).

        Args:
            times: (s), shape (...).
            position: (m), shape (..., N, 2).
            velocity: (m/s), shape (..., N, 2).
        """
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
        apart = position[..., self._first, :] - position[..., self._second, :]
        drift = velocity[..., self._first, :] - velocity[..., self._second, :]
        wanted = self._slots[self._first] - self._slots[self._second]
        force = consensus_force(
            apart[..., 0], apart[..., 1], drift[..., 0], drift[..., 1],
            self._delta, self._delta_v, wanted[:, 0], wanted[:, 1],
        )  # fmt: skip
        return np.stack([x @ self._incidence for x in force], axis=-1)  # robot j feels the opposite of robot i

    def _avoid(self, position: Array) -> Array:
        """The sum of what the sensed obstacles exert."""
        result = np.zeros_like(position)
        for x, y, radius in self._obstacles:
            dx, dy = position[..., 0] - x, position[..., 1] - y
            with np.errstate(divide="ignore", invalid="ignore"):  # in its middle, where no run goes on
                force = np.stack(avoidance_force(dx, dy, radius, self._range, self._gain), axis=-1)
            result += self._sensed(dx * dx + dy * dy)[..., None] * force
        return result

    def _sensed(self, squared_distances: Array) -> Array:
        """1 for each robot that is allowed to see an obstacle, else 0; shape (..., N)."""
        if not self._nearest:
            return np.ones_like(squared_distances)
        columns = list(np.moveaxis(squared_distances, -1, 0))
        return np.stack([nearest(columns, i) for i in range(len(columns))], axis=-1)


def spring_forces(scenario: Scenario, phase: Array, position: Array, velocity: Array) -> Array:
    """What the springs exert on each robot (paper, Eqs. 2-7; N), shape (m, N, 2).

    Args:
        scenario: a sound scenario.
        phase: 0 during aggregation, 1 during transport, where they are engaged; shape (m,).
        position: (m), shape (m, N, 2).
        velocity: (m/s), shape (m, N, 2).
    """
    edges, slots = graphs.edges(derive.spring_graph(scenario)), derive.slots(scenario)
    first, second = [i for i, _ in edges], [j for _, j in edges]
    apart, drift = position[:, first] - position[:, second], velocity[:, first] - velocity[:, second]
    wanted = slots[first] - slots[second]
    with np.errstate(all="ignore"):  # robots that met, or whose run diverged
        force = SPRING_LAWS[scenario.springs.law](
            apart[..., 0], apart[..., 1], drift[..., 0], drift[..., 1],
            derive.each(scenario.springs.stiffness, len(edges)), derive.each(scenario.springs.damping, len(edges)),
            wanted[:, 0], wanted[:, 1],
        )  # fmt: skip
        ends = np.eye(len(slots))
        engaged: Array = np.stack([x @ (ends[second] - ends[first]) for x in force], axis=-1)
    return np.where(phase[:, None, None] == 1, engaged, 0.0)
