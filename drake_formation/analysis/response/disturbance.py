"""What forces and noise do to the consensus error e_i = s_i − mean(s) (paper, Eq. 19).

A force acts on a robot as an obstacle's does, but comes from outside: that the avoidance force itself depends on where
the robot is, is not covered. e is the same whichever way the formation moves as a whole.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation, own
from drake_formation.analysis.linear.norms import (
    ResonancePeak,
    StateSpace,
    frequency_response,
    hinf_norm,
    largest_gain,
    pole_frequencies,
    require_stable,
    steady_covariance,
)
from drake_formation.analysis.response.impulse_peak import ImpulsePeaks, impulse_peaks
from drake_formation.systems.consensus_error import consensus_errors

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Disturbance:
    """How far forces and noise drive a formation from agreement.

    Spectral densities are one-sided, as data sheets give them: a band of 1 Hz of a noise of 1 N/√Hz has an RMS of 1 N
    on each axis.

    Attributes:
        pulse: the error of any robot for a force on robot j is at most this much for every N s of its total impulse
            ∫ ‖f‖ dt, however it is spread over time (m per N s), for every j; nearly reached by a short blow.
        h2: RMS of ‖e‖, all robots together, for white force noise of unit intensity on robot j (m per N √s), for
            every j; also the energy of the response to a blow.
        h2_all: the same for independent noise on all robots.
        hinf: amplitude of ‖e‖, all robots together, for the worst sinusoidal force on any one robot (m/N, at rad/s).
        hinf_robot: the robot on which it acts, from 1.
        hinf_all: the same for the worst forces on all robots at once, per amplitude of all forces together.
        force_floor: steady RMS of ‖e_i‖ of every robot for independent white force noise on all (m per N/√Hz).
        position_floor: the same for noise in the positions that robots communicate (m per m/√Hz).
        velocity_floor: the same for noise in the velocities that they communicate (m per m/s/√Hz).
    """

    pulse: ImpulsePeaks
    h2: Array
    h2_all: float
    hinf: ResonancePeak
    hinf_robot: int
    hinf_all: ResonancePeak
    force_floor: Array
    position_floor: Array
    velocity_floor: Array

    def error_bound(self, impulses: ArrayLike) -> float:
        """Largest consensus error of any robot when each robot j receives at most a total impulse J_j.

        Args:
            impulses: J_j (N s), shape (N,); one number hits one robot only, whichever it may be.

        Returns:
            The bound (m).
        """
        each = np.asarray(impulses, dtype=float)
        return float(self.pulse.bound.max() * each) if each.ndim == 0 else float(self.pulse.bound @ each)

    def to_dict(self) -> dict[str, Any]:
        """Plain values, units in the keys; robots are numbered from 1."""
        hit = int(np.argmax(self.pulse.bound))
        return {
            "pulse_error_m_per_ns": float(self.pulse.bound[hit]),
            "pulse_on_robot": hit + 1,
            "pulse_error_at_robot": int(self.pulse.robot[hit]) + 1,
            "pulse_error_after_s": float(self.pulse.time[hit]),
            "pulse_error_m_per_ns_by_robot": self.pulse.bound.tolist(),
            "h2_m_per_n_sqrt_s_by_robot": self.h2.tolist(),
            "h2_all_m_per_n_sqrt_s": self.h2_all,
            "hinf_m_per_n": self.hinf.gain,
            "hinf_frequency_rad_per_s": self.hinf.frequency,
            "hinf_on_robot": self.hinf_robot,
            "hinf_all_m_per_n": self.hinf_all.gain,
            "hinf_all_frequency_rad_per_s": self.hinf_all.frequency,
            "rms_m_per_n_per_sqrt_hz": float(self.force_floor.max()),
            "rms_m_per_m_per_sqrt_hz_position": float(self.position_floor.max()),
            "rms_m_per_m_per_s_per_sqrt_hz_velocity": float(self.velocity_floor.max()),
        }


def disturbance(formation: LinearFormation, *, delta: float | None = None, delta_v: float | None = None) -> Disturbance:
    """What forces and noise do to the consensus error.

    The work grows as N⁴: N Hamiltonian matrices of size 8N, one for each robot a sinusoidal force may act on.

    Args:
        formation: the linearized formation.
        delta: consensus gain δ (N/m) instead of the scenario's.
        delta_v: velocity consensus gain δ_v (N s/m) instead of the scenario's.

    Raises:
        IllPosedError: there is one robot only, or the loop is not stable.
    """
    gains = (formation.delta if delta is None else delta, formation.delta_v if delta_v is None else delta_v)
    system = force_to_error(formation, *gains)
    require_stable(system.A)
    h2 = _h2_by_robot(system)
    robot, one, all_robots = _resonances(system)
    positions, velocities = _communication_noise(formation, *gains)
    return Disturbance(
        pulse=impulse_peaks(system),
        h2=h2,
        h2_all=float(np.linalg.norm(h2)),
        hinf=one,
        hinf_robot=robot + 1,
        hinf_all=all_robots,
        force_floor=noise_floor(system),
        position_floor=noise_floor(system._replace(B=positions)),
        velocity_floor=noise_floor(system._replace(B=velocities)),
    )


def force_to_error(formation: LinearFormation, delta: float, delta_v: float) -> StateSpace:
    """From forces on the robots (N) to the consensus errors (m), x and y robot after robot.

    Raises:
        IllPosedError: there is one robot only.
    """
    if formation.robots < 2:
        raise IllPosedError("one robot always agrees with itself: a consensus error takes at least two robots")
    return StateSpace(formation.closed_loop(delta, delta_v), formation.B, error_outputs(formation.robots))


def error_outputs(robots: int) -> Array:
    """Consensus errors from states: the law of the diagram's own observer, column by column, shape (2N, 4N)."""
    unit = np.eye(STATES * robots).reshape(-1, robots, STATES)
    errors = consensus_errors(unit[..., :2], np.zeros((robots, 2)))
    result: Array = errors.reshape(STATES * robots, 2 * robots).T
    return result


def noise_floor(system: StateSpace) -> Array:
    """Steady RMS of ‖e_i‖ of every robot for independent white noise of one-sided unit density on every input.

    Raises:
        IllPosedError: the system is not stable.
    """
    require_stable(system.A)
    # Half of the one-sided density is the intensity: the other half lies at negative frequencies.
    covariance = steady_covariance(system.A, system.B @ system.B.T / 2)
    variances = np.einsum("ij,jk,ik->i", system.C, covariance, system.C).reshape(-1, 2).sum(axis=1)
    result: Array = np.sqrt(np.maximum(variances, 0.0))
    return result


def _h2_by_robot(system: StateSpace) -> Array:
    """H2 norms from each robot's force, all from the observability Gramian."""
    gramian = steady_covariance(system.A.T, system.C.T @ system.C)
    energies = np.einsum("ji,jk,ki->i", system.B, gramian, system.B).reshape(-1, 2).sum(axis=1)
    result: Array = np.sqrt(np.maximum(energies, 0.0))
    return result


def _resonances(system: StateSpace) -> tuple[int, ResonancePeak, ResonancePeak]:
    """The robot (from 0) on which a sinusoidal force does most, what it does, and what forces on all robots do."""
    frequencies = pole_frequencies(system.A)
    response = frequency_response(system, frequencies)
    on_one = [slice(2 * robot, 2 * robot + 2) for robot in range(system.B.shape[1] // 2)]
    starts = [largest_gain(response[:, :, columns], frequencies) for columns in on_one]
    order = sorted(range(len(starts)), key=lambda robot: -starts[robot].gain)
    robot, worst = order[0], starts[order[0]]
    for other in order:
        peak = hinf_norm(system._replace(B=system.B[:, on_one[other]]), start=worst)
        if peak.gain > worst.gain:
            robot, worst = other, peak
    return robot, worst, hinf_norm(system, start=largest_gain(response, frequencies))


def _communication_noise(formation: LinearFormation, delta: float, delta_v: float) -> tuple[Array, Array]:
    """What noise in communicated positions (m) and velocities (m/s) does to the states, each of shape (4N, 2N).

    A robot sends one noisy state to all its neighbours and uses its own true one.
    """
    consensus = formation.consensus(delta, delta_v)
    heard = (consensus - own(consensus)).reshape(len(consensus), -1, STATES)
    return heard[..., :2].reshape(len(consensus), -1), heard[..., 2:].reshape(len(consensus), -1)
