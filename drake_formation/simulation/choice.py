"""Which engine runs a scenario fastest, from the scenario alone: a run that is repeated takes the same one.

The numbers are those of one ordinary processor; only their ratios matter. Neither the clock nor the compile cache has
a say, as either would let the same scenario end in other last digits.
"""

from dataclasses import dataclass

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.formation import graphs
from drake_formation.parameters import tracking_gain
from drake_formation.scenario import Scenario, ScenarioError, derive
from drake_formation.simulation.phases import felt_obstacles

Array = NDArray[np.float64]

COMPILE_SECONDS = 5.0
"""Tracing a diagram and compiling it, as on its first use."""
ROBOT_SECONDS, COUPLING_SECONDS, OBSTACLE_SECONDS = 3e-4, 6e-5, 1e-5
"""What a step of the blocks takes for each robot, each spring or channel, and each obstacle of each robot."""
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
    robots = derive.robot_count(scenario.formation)
    couplings = derive.spring_graph(scenario).size() + derive.communication_graph(scenario).size()
    step: float = robots * (ROBOT_SECONDS + OBSTACLE_SECONDS * len(scenario.avoidance.obstacles))
    step += COUPLING_SECONDS * couplings
    transports = 2 if felt_obstacles(scenario) else 1
    aggregation = steps(scenario, scenario.aggregation.duration, carrying=False)
    return step * (aggregation + transports * steps(scenario, scenario.transport.duration, carrying=True))


def steps(scenario: Scenario, duration: float, *, carrying: bool) -> float:
    """How many steps Drake's integrator takes in a phase, about.

    The longest is bounded by the settings, and by the fastest mode as long as that rings or where it bounds stability.

    Args:
        scenario: a sound scenario.
        duration: of the phase (s).
        carrying: whether the springs are engaged.
    """
    settings = scenario.simulator
    if not settings.use_error_control:
        return duration / settings.max_step_size
    stiffness, damping = _largest_rates(scenario, carrying)
    fastest = float(np.sqrt(stiffness))
    accurate = ACCURATE * (settings.accuracy / 1e-6) ** 0.2
    ringing = min(duration, FADED / damping)
    fewest = max(1 / settings.max_step_size, max(fastest, damping) / STABLE)
    return float(duration * fewest + ringing * fastest / accurate)


def _largest_rates(scenario: Scenario, carrying: bool) -> tuple[float, float]:
    """Bounds on the stiffness and the damping of the fastest mode by its mass (1/s², 1/s), by Gershgorin's circles."""
    masses = derive.masses(scenario)
    talks, springs = derive.communication_graph(scenario), derive.spring_graph(scenario)
    gains = [tracking_gain(scenario, float(mass)) for mass in masses]
    stiffness = np.array([np.linalg.norm(gain[:, :2], 2) for gain in gains])
    damping = np.array([np.linalg.norm(gain[:, 2:], 2) for gain in gains])
    stiffness += 2 * _sums(talks, scenario.consensus.delta)
    damping += 2 * _sums(talks, scenario.consensus.delta_v)
    if carrying:
        stiffness += 2 * _sums(springs, scenario.springs.stiffness)
        damping += 2 * _sums(springs, scenario.springs.damping)
    return float((stiffness / masses).max()), float((damping / masses).max())


def _sums(graph: nx.Graph, weights: float | tuple[float, ...]) -> Array:
    """Sum of the weights of each robot's edges, shape (N,)."""
    edges = graphs.edges(graph)
    sums = np.zeros(graph.number_of_nodes())
    for (i, j), weight in zip(edges, derive.each(weights, len(edges)), strict=True):
        sums[[i, j]] += weight
    return sums
