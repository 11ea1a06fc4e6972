"""The blocks are integrated as one system would be.

Error-controlled runge_kutta5 and bogacki_shampine3 restore the state after a rejected step without invalidating the
caches; an output that depends on the state alone then stays stale. The plant's outputs depend on the time for that
reason. Tried once without the time ticket, on Drake 1.51.1 and 1.58.0 alike, the test below fails: runge_kutta5 takes
320 steps (159 rejected) instead of 268 (43) and ends 1.3 m off, bogacki_shampine3 1025 (865) instead of 710 (154) and
ends 0.4 m off.
"""

import numpy as np
import pytest
from probe import context_at, state_of
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import LeafSystem

from drake_formation.diagram import build_diagram
from drake_formation.formation import graphs
from drake_formation.formation.names import robot_name
from drake_formation.parameters import block_parameters
from drake_formation.parts.avoidance.khatib import avoidance_force
from drake_formation.parts.coordination.consensus import consensus_force
from drake_formation.parts.tracking.lqr import tracking_force
from drake_formation.scenario import load_scenario, resolve

DURATION = 5.0


class Monolith(LeafSystem):
    """The transport as one system with all the state and no cache, from the laws of the blocks."""

    def __init__(self, scenario):
        super().__init__()
        self.scenario = scenario
        self.law = resolve(scenario).law.law
        self.parameters = block_parameters(resolve(scenario))
        self.robots = resolve(scenario).robots
        self.held = [graphs.neighbours(resolve(scenario).springs.graph, i) for i in range(self.robots)]
        self.heard = [graphs.neighbours(resolve(scenario).channels.graph, i) for i in range(self.robots)]
        self.DeclareContinuousState(2 * self.robots, 2 * self.robots, 0)

    def DoCalcTimeDerivatives(self, context, derivatives):  # noqa: N802 - Drake's name
        flat = context.get_continuous_state_vector().CopyToVector()
        q, v = flat.reshape(2, self.robots, 2)
        accelerations = [self.force(i, np.hstack([q, v]).tolist()) / self.numbers(i, "plant")[0] for i in range(len(q))]
        derivatives.SetFromVector(np.concatenate([v.ravel(), *accelerations]))

    def numbers(self, robot, block):
        return self.parameters[f"{robot_name(robot)}/{block}"]

    def force(self, i, states):
        gain, _, slot = self.numbers(i, "tracking")
        error = np.array(states[i]) - [*(np.array(self.scenario.transport.goal) + slot), 0, 0]
        force = np.array(tracking_force(tuple(error.tolist()), np.ravel(gain).tolist()))
        _, springs = self.numbers(i, "plant")
        for j, numbers in zip(self.held[i], springs, strict=True):
            force -= self.law(*np.subtract(states[i], states[j]), *numbers)
        gains, displacements = self.numbers(i, "consensus")
        for j, displacement in zip(self.heard[i], displacements, strict=True):
            force += consensus_force(*np.subtract(states[i], states[j]), *gains, *displacement)
        field, obstacles = self.numbers(i, "avoidance")
        for x, y, radius in np.reshape(obstacles, (-1, 3)):
            force += avoidance_force(states[i][0] - x, states[i][1] - y, radius, *field)
        return force


@pytest.fixture(params=["runge_kutta5", "bogacki_shampine3"])
def scenario(request):
    """Four robots that are let go out of formation, held by hard springs, next to an obstacle."""
    return load_scenario(
        "quadrilateral",
        overrides={
            "springs.stiffness": 3e4,
            "consensus.delta": 1e4,
            "avoidance.obstacles": [{"position": [1.6, 4.6], "radius": 0.0}],
            "aggregation.duration": 0.0,
            "transport.goal": [5.0, 3.5],
            "simulator.integration_scheme": request.param,
            "simulator.accuracy": 1e-3,
        },
    )


def start(scenario):
    """Robots at rest, a few centimetres off their slots, shape (4, 4)."""
    off = [[0.02, 0.0], [0.0, 0.0], [0.0, 0.03], [0.0, 0.0]]
    positions = [1.6875, 3.5125] + resolve(scenario).slots * [1.05, 0.98] + off
    return np.hstack([positions, np.zeros((4, 2))])


def advance(scenario, system, context):
    """Steps taken and steps rejected."""
    simulator = Simulator(system, context)
    ApplySimulatorConfig(SimulatorConfig(**scenario.simulator.model_dump()), simulator)
    simulator.AdvanceTo(DURATION)
    integrator = simulator.get_integrator()
    return integrator.get_num_steps_taken(), integrator.get_num_step_shrinkages_from_error_control()


def run_blocks(scenario):
    """Steps taken and rejected, and the final state of every robot."""
    diagram = build_diagram(scenario)
    context = context_at(diagram, start(scenario))
    return advance(scenario, diagram, context), state_of(context)


def run_monolith(scenario):
    """The same of one system."""
    monolith = Monolith(scenario)
    context = monolith.CreateDefaultContext()
    context.SetContinuousState(np.concatenate([part.ravel() for part in np.hsplit(start(scenario), 2)]))
    steps = advance(scenario, monolith, context)
    positions, velocities = context.get_continuous_state_vector().CopyToVector().reshape(2, -1, 2)
    return steps, np.hstack([positions, velocities])


def test_the_blocks_take_the_steps_of_one_system(scenario):
    (steps, rejected), final = run_blocks(scenario)
    (expected_steps, expected_rejected), expected_final = run_monolith(scenario)
    assert rejected > 10, "no step was rejected: the test says nothing"
    assert (steps, rejected) == (expected_steps, expected_rejected)
    np.testing.assert_allclose(final, expected_final, rtol=0, atol=1e-9)
