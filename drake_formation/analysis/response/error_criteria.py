"""By which consensus error a communication graph is judged: the error under one stated disturbance."""

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.assumptions import require_start_at_rest
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.linear.norms import StateSpace, hinf_norm
from drake_formation.analysis.response.disturbance import error_outputs, force_to_error, noise_floor
from drake_formation.analysis.response.impulse_peak import impulse_peaks
from drake_formation.scenario import Scenario, resolve

Array = NDArray[np.float64]


class Measure(Protocol):
    """A consensus error (m) that follows from the linearized loop.

    Attributes:
        of_every_robot: whether it treats all robots alike, so that renumbering them changes nothing.
    """

    of_every_robot: ClassVar[bool]

    def error_m(self, formation: LinearFormation) -> float:
        """The error (m).

        Raises:
            IllPosedError: the loop is not stable, or there is one robot only.
        """

    def __str__(self) -> str:
        """What the error is, in words."""


@dataclass(frozen=True)
class Pulse:
    """The worst error of any robot for a force of this total impulse on any one robot, however spread over time."""

    impulse_ns: float = 1.0
    of_every_robot: ClassVar[bool] = True

    def error_m(self, formation: LinearFormation) -> float:
        """The error (m), within 0.1 % from above."""
        peaks = impulse_peaks(force_to_error(formation, formation.delta, formation.delta_v))
        return self.impulse_ns * float(peaks.bound.max())

    def __str__(self) -> str:
        """What the error is, in words."""
        return f"worst error for a force of impulse {self.impulse_ns:g} N s on one robot"


@dataclass(frozen=True)
class ForceNoise:
    """The steady RMS error of the worst robot for independent white forces on all robots (one-sided density)."""

    density_n_per_sqrt_hz: float = 1.0
    of_every_robot: ClassVar[bool] = True

    def error_m(self, formation: LinearFormation) -> float:
        """The error (m)."""
        system = force_to_error(formation, formation.delta, formation.delta_v)
        return self.density_n_per_sqrt_hz * float(noise_floor(system).max())

    def __str__(self) -> str:
        """What the error is, in words."""
        return f"RMS error of the worst robot for white forces of {self.density_n_per_sqrt_hz:g} N/√Hz on all"


@dataclass(frozen=True)
class Vibration:
    """The amplitude of all errors together for the worst sinusoidal forces, of this amplitude all together."""

    amplitude_n: float = 1.0
    of_every_robot: ClassVar[bool] = True

    def error_m(self, formation: LinearFormation) -> float:
        """The error (m)."""
        system = force_to_error(formation, formation.delta, formation.delta_v)
        return self.amplitude_n * hinf_norm(system).gain

    def __str__(self) -> str:
        """What the error is, in words."""
        return f"amplitude of all errors together for the worst sinusoidal forces of {self.amplitude_n:g} N together"


@dataclass(frozen=True)
class HandOff:
    """The worst error of any robot from the hand-off on, of a scenario without obstacles (paper, Fig. 23).

    The robots gather from the scenario's own starts, without the object, for the scenario's own time; what residual
    is left then, and the step to the goal, move them from there on. All of it on the linearized loop.
    """

    scenario: Scenario
    of_every_robot: ClassVar[bool] = False

    def error_m(self, formation: LinearFormation) -> float:
        """The error (m), within 0.1 % from above."""
        outputs = error_outputs(formation.robots)
        # One column of the two is enough for one motion.
        motion = np.column_stack([self.residual(formation), np.zeros(outputs.shape[1])])
        return float(impulse_peaks(StateSpace(formation.A, motion, outputs)).bound[0])

    def residual(self, formation: LinearFormation) -> Array:
        """Deviation from the goal at the hand-off, robot after robot (m, m/s), shape (4N,).

        Raises:
            IllPosedError: the reference is no set point, the scenario is of another number of robots, or its robots do
                not start at rest.
        """
        from scipy.linalg import expm

        own = resolve(self.scenario)
        kind = own.parts["reference"][0].kind
        if kind != "set_point" or own.robots != formation.robots:
            raise IllPosedError(
                "the error from the hand-off on is defined for a set point as reference and the formation's own "
                f"number of robots; scenario {own.name!r} has reference {kind} and {own.robots} robots, the formation "
                f"{formation.robots}"
            )
        require_start_at_rest(own)
        start = _at_rest(own.starts - own.centre - own.slots)
        gathering = formation.tracking + formation.consensus(formation.delta, formation.delta_v)
        step = _at_rest(np.broadcast_to(own.centre - own.goal, (formation.robots, 2)))
        result: Array = expm(gathering * own.aggregation_duration) @ start + step
        return result

    def __str__(self) -> str:
        """What the error is, in words."""
        return f"worst error from the hand-off on in {self.scenario.name} without obstacles"


def _at_rest(positions: Array) -> Array:
    result: Array = np.hstack([positions, np.zeros_like(positions)]).ravel()
    return result
