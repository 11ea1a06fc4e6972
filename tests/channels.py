"""The diagram's robots with their consensus controllers taken out, so that a test can put a delay or a loss between.

Plants, springs and tracking controllers are the diagram's own blocks with its parameters, compiled; the consensus force
comes in from outside, from the law that the consensus block shares.
"""

import numpy as np
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Adder, ConstantVectorSource

from drake_formation.formation import graphs
from drake_formation.formation.names import robot_name
from drake_formation.lowering import lower
from drake_formation.parameters import block_parameters
from drake_formation.parts.coordination.consensus import consensus_force
from drake_formation.parts.references.set_point import SetPoint
from drake_formation.parts.robots.point_mass import RobotPlant
from drake_formation.parts.tracking.controller import TrackingController
from drake_formation.parts.tracking.lqr import lqr_force
from drake_formation.scenario import resolve


class OpenChannels:
    """Robots of a scenario at rest (``LinearFormation.scenario``).

    ``to`` and ``of`` are the robots that each directed channel goes to and comes from; ``rest`` is the state (4N,).
    """

    def __init__(self, scenario):
        graph = resolve(scenario).channels.graph
        pairs = [(i, j) for i in sorted(graph) for j in graphs.neighbours(graph, i)]
        self.to, self.of = np.array(pairs).T
        slots = resolve(scenario).slots
        self.displacements = slots[self.to] - slots[self.of]
        self.gains = scenario.consensus.delta, scenario.consensus.delta_v
        diagram, self.rest = _without_consensus(scenario)
        self._compiled = lower(diagram)
        context = diagram.CreateDefaultContext()
        ports = [diagram.get_input_port(k) for k in range(diagram.num_input_ports())]
        for k, port in enumerate(ports):
            port.FixValue(context, [1e6 + 2 * k, 1e6 + 2 * k + 1])
        self._values = self._compiled.read(context)
        self._places = np.array([np.flatnonzero(self._values == 1e6 + k)[0] for k in range(2 * len(ports))])

    def channel_forces(self, own, heard):
        """What each channel adds to the force on its robot (N), shape (channels, 2).

        ``own`` and ``heard`` are the states of the robot and of its neighbour as they are compared, (channels, 4).
        """
        difference = own - heard
        return np.stack(consensus_force(*difference.T, *self.gains, *self.displacements.T), axis=-1)

    def forces(self, channel_forces):
        """Their sums for every robot, shape (N, 2)."""
        result = np.zeros((len(self.rest) // 4, 2))
        np.add.at(result, self.to, channel_forces)
        return result

    def derivatives(self, state, forces):
        """Time derivatives of all robots, shape (4N,), under consensus forces (N, 2)."""
        self._values[self._places] = forces.ravel()
        return self._compiled.derivatives(0.0, state, self._values)

    def held_period(self, state, heard, arrives, lost, period, steps=4):
        """The state (4N,) a sampling period later, and what was heard last, (channels, 4); forces are held.

        Of the channels for which ``arrives`` is not true, the term is left out (``zero``) or uses ``heard`` (``hold``).
        """
        sent = state.reshape(-1, 4)
        heard = np.where(arrives[:, None], sent[self.of], heard)
        pulls = self.channel_forces(sent[self.to], heard)
        forces = self.forces(pulls if lost == "hold" else np.where(arrives[:, None], pulls, 0.0))
        h = period / steps
        for _ in range(steps):
            first = self.derivatives(state, forces)
            second = self.derivatives(state + h / 2 * first, forces)
            third = self.derivatives(state + h / 2 * second, forces)
            fourth = self.derivatives(state + h * third, forces)
            state = state + h / 6 * (first + 2 * second + 2 * third + fourth)
        return state, heard


def _without_consensus(scenario):
    formation = resolve(scenario)
    parameters = block_parameters(formation)
    builder = DiagramBuilder()
    phase = builder.AddNamedSystem("phase", ConstantVectorSource([1.0]))
    reference = builder.AddNamedSystem("reference", SetPoint(*parameters["reference"]))
    builder.Connect(phase.get_output_port(), reference.GetInputPort("phase"))
    springs, starts = resolve(scenario).springs.graph, resolve(scenario).starts
    start = np.hstack([starts, np.zeros_like(starts)])
    plants = []
    for i, state in enumerate(start):
        name = robot_name(i)
        held = [j + 1 for j in graphs.neighbours(springs, i)]
        plant = RobotPlant(held, formation.law, *parameters[f"{name}/plant"], state)
        *numbers, slot = parameters[f"{name}/tracking"]
        tracking = TrackingController(lqr_force, numbers, slot)
        plants.append(builder.AddNamedSystem(f"{name}_plant", plant))
        builder.AddNamedSystem(f"{name}_tracking", tracking)
        control = builder.AddNamedSystem(f"{name}_control", Adder(2, 2))
        builder.Connect(plant.GetOutputPort("state"), tracking.GetInputPort("state"))
        builder.Connect(reference.get_output_port(), tracking.GetInputPort("reference"))
        builder.Connect(tracking.GetOutputPort("force"), control.get_input_port(0))
        builder.ExportInput(control.get_input_port(1), f"{name}_consensus")
        builder.Connect(control.get_output_port(), plant.GetInputPort("force"))
        builder.Connect(phase.get_output_port(), plant.GetInputPort("phase"))
    for i, j in graphs.edges(springs):
        builder.Connect(plants[j].GetOutputPort("state"), plants[i].GetInputPort(f"spring_{j + 1}"))
        builder.Connect(plants[i].GetOutputPort("state"), plants[j].GetInputPort(f"spring_{i + 1}"))
    return builder.Build(), start.ravel()
