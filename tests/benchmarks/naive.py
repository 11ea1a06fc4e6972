"""The blocks as one would first write them: small arrays, ports looked up by name. The yardstick for the real ones."""

from contextlib import ExitStack
from unittest.mock import patch

import numpy as np
from pydrake.systems.framework import BasicVector, LeafSystem

from drake_formation import build_diagram
from drake_formation.parts.avoidance.khatib import avoidance_force
from drake_formation.parts.coordination.consensus import consensus_force
from drake_formation.parts.springs.hookean import Hookean
from drake_formation.parts.tracking.lqr import lqr_force


class Plant(LeafSystem):
    """A mass with spring ports."""

    def __init__(self, neighbours, law, mass, springs, initial_state, *, load, **options):
        super().__init__()
        assert law is Hookean
        assert not load
        assert not any(options.values())
        self.neighbours, self.mass, self.springs = neighbours, mass[0], springs
        self.DeclareVectorInputPort("force", 2)
        self.DeclareVectorInputPort("phase", 1)
        for j in neighbours:
            self.DeclareVectorInputPort(f"spring_{j}", 4)
        self.DeclareContinuousState(BasicVector(initial_state), 2, 2, 0)
        state = {self.xc_ticket(), self.time_ticket()}
        self.DeclareVectorOutputPort("state", 4, self.calc_state, state)
        self.DeclareVectorOutputPort("spring_force", 2, self.calc_spring_force)

    def calc_state(self, context, output):
        output.SetFromVector(context.get_continuous_state_vector().CopyToVector())

    def calc_spring_force(self, context, output):
        output.SetFromVector(self.spring_force(context))

    def spring_force(self, context):
        x = context.get_continuous_state_vector().CopyToVector()
        force = np.zeros(2)
        for j, (stiffness, _, *displacement) in zip(self.neighbours, self.springs, strict=True):
            neighbour = self.GetInputPort(f"spring_{j}").Eval(context)
            between = x[:2] - neighbour[:2]
            force -= stiffness * (1 - np.linalg.norm(displacement) / np.linalg.norm(between)) * between
        return force * self.GetInputPort("phase").Eval(context)

    def DoCalcTimeDerivatives(self, context, derivatives):  # noqa: N802
        x = context.get_continuous_state_vector().CopyToVector()
        force = self.GetInputPort("force").Eval(context) + self.spring_force(context)
        derivatives.get_mutable_vector().SetFromVector(np.concatenate([x[2:], force / self.mass]))


class Tracking(LeafSystem):
    """u_l."""

    def __init__(self, law, numbers, slot):
        super().__init__()
        gain, inertia = numbers
        assert law is lqr_force
        assert not np.any(inertia)
        self.gain, self.slot = np.asarray(gain), np.asarray(slot)
        self.DeclareVectorInputPort("state", 4)
        self.DeclareVectorInputPort("reference", 6)
        self.DeclareVectorOutputPort("force", 2, self.calc_force)
        self.DeclareVectorOutputPort("error", 4, self.calc_error)

    def error(self, context):
        reference = self.GetInputPort("reference").Eval(context)[:4] + np.concatenate([self.slot, np.zeros(2)])
        return self.GetInputPort("state").Eval(context) - reference

    def calc_force(self, context, output):
        output.SetFromVector(-self.gain @ self.error(context))

    def calc_error(self, context, output):
        output.SetFromVector(self.error(context))


class Consensus(LeafSystem):
    """u_g."""

    def __init__(self, neighbours, gains, displacements, *, law):
        super().__init__()
        assert law is consensus_force
        self.neighbours, self.gains, self.displacements = neighbours, gains, displacements
        self.DeclareVectorInputPort("state", 4)
        for j in neighbours:
            self.DeclareVectorInputPort(f"channel_{j}", 4)
        self.DeclareVectorOutputPort("force", 2, self.calc_force)

    def calc_force(self, context, output):
        delta, delta_v = self.gains
        force = np.zeros(2)
        for j, displacement in zip(self.neighbours, self.displacements, strict=True):
            x = self.GetInputPort("state").Eval(context)
            relative = x - self.GetInputPort(f"channel_{j}").Eval(context)
            force -= delta * (relative[:2] - displacement) + delta_v * relative[2:]
        output.SetFromVector(force)


class Avoidance(LeafSystem):
    """The potential field."""

    def __init__(self, field, obstacles, masked, law, neighbours, *unused):
        super().__init__()
        assert law is avoidance_force
        assert not masked
        assert not neighbours
        self.field, self.obstacles = field, np.reshape(obstacles, (-1, 3))
        self.DeclareVectorInputPort("state", 4)
        self.DeclareVectorInputPort("phase", 1)
        self.DeclareVectorOutputPort("force", 2, self.calc_force)

    def calc_force(self, context, output):
        sensing_range, gain = self.field
        position = self.GetInputPort("state").Eval(context)[:2]
        force = np.zeros(2)
        for *centre, radius in self.obstacles:
            away = position - np.array(centre)
            clearance = np.linalg.norm(away) - radius
            if clearance < sensing_range:
                force += gain * (1 / clearance - 1 / sensing_range) / clearance**2 * away / np.linalg.norm(away)
        output.SetFromVector(force * self.GetInputPort("phase").Eval(context))


BLOCKS = {
    "robots.point_mass.RobotPlant": Plant,
    "tracking.lqr.TrackingController": Tracking,
    "coordination.consensus.ConsensusController": Consensus,
    "avoidance.khatib.ObstacleAvoidance": Avoidance,
}
"""What each block of the parts is replaced by."""


def naive_diagram(scenario):
    """The same wiring with naive blocks."""
    with ExitStack() as stack:
        for name, block in BLOCKS.items():
            stack.enter_context(patch(f"drake_formation.parts.{name}", block))
        return build_diagram(scenario)
