"""Which engine runs a scenario fastest, from the scenario alone: a run that is repeated takes the same one.

The numbers are those of one ordinary processor; only their ratios matter. Neither the clock nor the compile cache has
a say, as either would let the same scenario end in other last digits.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.parameters import placed_parts
from drake_formation.parts.actuators.motor import MotorActuator
from drake_formation.parts.objects.breaking import looks_every
from drake_formation.parts.objects.carried import CarriedObject
from drake_formation.parts.part import Part
from drake_formation.parts.tracking.lqr import Lqr, lqr_gain
from drake_formation.scenario import Scenario, ScenarioError, resolve
from drake_formation.simulation.phases import felt_obstacles

Array = NDArray[np.float64]

COMPILE_SECONDS = 5.0
"""Tracing a diagram and compiling it, as on its first use."""
ROBOT_SECONDS, COUPLING_SECONDS, OBSTACLE_SECONDS = 3e-4, 6e-5, 1e-5
"""What a step of the blocks takes for each robot, each spring or channel, and each obstacle of each robot."""
UPDATE_SECONDS = 6e-5
"""What an update of a sampled block takes."""
STABLE, ACCURATE = 3.3, 0.3
"""Longest step times the fastest rate: where that has died out, and where it rings at an accuracy of 1e-6."""
FADED = 20.0
"""A mode has faded away after this many of its time constants m/c."""


@dataclass(frozen=True)
class Choice:
    """What runs a scenario.

    Attributes:
        engine: a key of :data:`drake_formation.simulation.engines.ENGINES`.
        reason: why.
    """

    engine: str
    reason: str


def choose(scenario: Scenario) -> Choice:
    """The blocks where they are done before they could be compiled, or where they cannot be; else the compiled ones.

    Args:
        scenario: a sound scenario.
    """
    expected = blocks_seconds(scenario)
    if expected <= COMPILE_SECONDS:
        return Choice("blocks", f"done in some {expected:.2g} s, sooner than it would be compiled")
    from drake_formation.simulation.compiled import require_compiled_settings  # the compiler is slow to import

    try:
        require_compiled_settings(scenario)
    except ScenarioError as error:
        return Choice("blocks", f"cannot be compiled: {error}")
    return Choice("compiled", f"the blocks would take some {expected:.2g} s")


def blocks_seconds(scenario: Scenario) -> float:
    """How long the blocks take for a scenario, about (s)."""
    formation = resolve(scenario)
    couplings = len(formation.springs.pairs) + len(formation.channels.pairs) / 2
    couplings += 2 * formation.robots * formation.has_body  # the object reads each robot, and it feels its grip
    step: float = formation.robots * (ROBOT_SECONDS + OBSTACLE_SECONDS * len(formation.obstacles))
    step += COUPLING_SECONDS * couplings
    transports = 2 if felt_obstacles(formation) else 1
    aggregation = steps(scenario, formation.aggregation_duration, carrying=False)
    transport = steps(scenario, formation.transport_duration, carrying=True)
    duration = formation.aggregation_duration + transports * formation.transport_duration
    updates = duration * sum(1 / period for period in _periods(formation))
    return step * (aggregation + transports * transport) + UPDATE_SECONDS * updates


def _periods(formation: Formation) -> list[float]:
    """How often each sampled block is updated (s)."""
    parts = [part for _, part, _ in placed_parts(formation)]
    updated = [period for part in parts for period, _ in part.ticks()]
    kept = [getattr(part, "keeps_every", 0.0) for part in parts]
    return updated + [every for every in kept if every]


def steps(scenario: Scenario, duration: float, *, carrying: bool) -> float:
    """How many steps Drake's integrator takes in a phase, about.

    The longest is bounded by the settings, and by the fastest mode as long as that rings or where it bounds stability.

    Args:
        scenario: a sound scenario.
        duration: of the phase (s).
        carrying: whether the springs are engaged.
    """
    settings = scenario.simulator
    looks = duration / looks_every(resolve(scenario)) if carrying else 0.0  # a step ends wherever one looks for breaks
    looks += duration * sum(1 / period for period in set(_periods(resolve(scenario))))
    if not settings.use_error_control:
        return duration / settings.max_step_size + looks
    stiffness, damping = _largest_rates(resolve(scenario), carrying)
    fastest = float(np.sqrt(stiffness))
    accurate = ACCURATE * (settings.accuracy / 1e-6) ** 0.2
    ringing = min(duration, FADED / damping) if damping else duration
    fewest = max(1 / settings.max_step_size, max(fastest, damping) / STABLE)
    return float(duration * fewest + ringing * fastest / accurate + looks)


def _largest_rates(formation: Formation, carrying: bool) -> tuple[float, float]:
    """Bounds on the stiffness and the damping of the fastest mode by its mass (1/s², 1/s), by Gershgorin's circles.

    Parts of other kinds than the paper's count as far as they have its numbers.
    """
    masses = formation.masses
    stiffness, damping = np.zeros(formation.robots), np.zeros(formation.robots)
    for i, part in enumerate(formation.parts["tracking"]):
        gain = (
            lqr_gain(float(masses[i]), part.state_cost, part.input_cost) if isinstance(part, Lqr) else np.zeros((2, 4))
        )
        stiffness[i], damping[i] = np.linalg.norm(gain[:, :2], 2), np.linalg.norm(gain[:, 2:], 2)
    heard = formation.channels.adjacency.sum(axis=1)
    stiffness += 2 * heard * _each(formation, "coordination", "delta")
    damping += 2 * heard * _each(formation, "coordination", "delta_v")
    if carrying:
        stiffness += 2 * _sums(formation, "stiffness")
        damping += 2 * _sums(formation, "damping")
    followed = [1 / part.given["time_constant"] for part in formation.parts["actuator"] if _follows(part)]
    (carried,) = formation.parts["object"]
    body = carried.fastest(formation) if carrying and isinstance(carried, CarriedObject) else (0.0, 0.0)
    return float((stiffness / masses).max()) + body[0], max([float((damping / masses).max()) + body[1], *followed])


def _follows(part: Part) -> bool:
    """Whether actuators follow with a time constant."""
    return isinstance(part, MotorActuator) and part.is_smooth


def _each(formation: Formation, role: str, name: str) -> Array:
    """A number of every part of a role, 0 where a kind has none of that name."""
    return np.array([getattr(part.config, name, 0.0) for part in formation.parts[role]], dtype=float)


def _sums(formation: Formation, name: str) -> Array:
    """Sum over each robot's springs, shape (N,)."""
    sums = np.zeros(formation.robots)
    for (i, j), value in zip(formation.springs.pairs.tolist(), _each(formation, "spring", name), strict=True):
        sums[[i, j]] += value
    return sums
