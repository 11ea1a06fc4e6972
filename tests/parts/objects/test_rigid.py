"""The rigid object: Newton, Euler, friction, energy, and the same built of Drake's MultibodyPlant."""

import numpy as np
import pytest
from carrying import UNLIKE, carried
from hypothesis import given
from hypothesis import strategies as st
from pydrake.common.value import Value
from pydrake.multibody.math import SpatialForce
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import PlanarJoint, SpatialInertia
from pydrake.systems.framework import DiagramBuilder, LeafSystem

from drake_formation import ScenarioError, simulate
from drake_formation.parts import Part, part, register, registry
from drake_formation.parts.objects.grips import grip_force
from drake_formation.parts.objects.rigid import GRAVITY, Rigid
from drake_formation.scenario import resolve

numbers = st.floats(-3, 3, allow_subnormal=False)
vectors = st.tuples(numbers, numbers)
states = st.lists(numbers, min_size=6, max_size=6).map(np.array)
four = st.lists(vectors, min_size=4, max_size=4)


def body(**fields):
    """Mechanics and numbers of an object that four robots in a square of 2 m hold."""
    formation = resolve(carried("{kind: rigid}"))
    rigid = Rigid(Rigid.Config(**fields))
    return rigid.mechanics(formation), rigid.own_numbers(formation)


@given(states, four)
def test_without_friction_the_grip_forces_are_mass_times_acceleration(state, forces):
    mechanics, its = body(mass=25.0)
    ax, ay, _ = mechanics.accelerations(state, forces, its)
    assert (25.0 * ax, 25.0 * ay) == pytest.approx(np.sum(forces, axis=0), abs=1e-12)


@given(states, four)
def test_the_torque_is_that_of_the_forces_where_the_robots_hold_it(state, forces):
    mechanics, its = body(inertia=7.0)
    arms = np.array([point[:2] for point in mechanics.points(state, range(4), its)]) - state[:2]
    np.testing.assert_allclose(np.hypot(*arms.T), np.sqrt(2.0))
    torque = (arms[:, 0] * np.array(forces)[:, 1] - arms[:, 1] * np.array(forces)[:, 0]).sum()
    assert 7.0 * mechanics.accelerations(state, forces, its)[2] == pytest.approx(torque, abs=1e-9)


@given(vectors, numbers)
def test_a_symmetric_pull_moves_it_without_turning(pull, heading):
    mechanics, its = body()
    state = np.array([1.0, 2.0, heading, 0.0, 0.0, 0.0])
    assert mechanics.accelerations(state, [pull] * 4, its)[2] == pytest.approx(0.0, abs=1e-12)


@given(states, four, four)
def test_the_energy_of_body_and_grips_decays(state, places, speeds):
    """Robots held fast: d/dt of kinetic and grip energy is what friction and the dampers take, and the robots give."""
    k, c = 3.0, 0.5
    mechanics, its = body(mass=4.0, inertia=2.0, friction=0.3)
    points = mechanics.points(state, range(4), its)
    robots = [(*place, *speed) for place, speed in zip(places, speeds, strict=True)]
    on_robots = np.array([grip_force(robot, point, k, c) for robot, point in zip(robots, points, strict=True)])
    rates = mechanics.accelerations(state, (-on_robots).tolist(), its)
    stretch, speed = (
        np.array(robots)[:, :2] - np.array(points)[:, :2],
        np.array(robots)[:, 2:] - np.array(points)[:, 2:],
    )
    gained = state[3:] @ (np.array([4.0, 4.0, 2.0]) * rates) + k * (stretch * speed).sum()
    given_by_robots = -(on_robots * np.array(speeds)).sum()
    assert gained - given_by_robots <= 1e-9


def test_friction_is_coulombs_at_speed_and_viscous_about_rest():
    mechanics, its = body(mass=10.0, friction=0.4, friction_speed=0.01)
    fast, slow = (
        mechanics.accelerations(np.array([0.0, 0.0, 0.0, 0.6 * v, 0.8 * v, 0.0]), [(0.0, 0.0)] * 4, its)
        for v in (5.0, 1e-6)
    )
    assert fast == pytest.approx([-0.4 * GRAVITY * 0.6, -0.4 * GRAVITY * 0.8, 0.0], rel=1e-5)
    assert slow == pytest.approx([-0.4 * GRAVITY * 0.6e-4, -0.4 * GRAVITY * 0.8e-4, 0.0], rel=1e-5)


def test_the_strain_is_the_largest_stretch_of_a_grip_by_the_size():
    mechanics, its = body()
    stretches = [(0.0, 0.0), (0.3, 0.4), (0.1, 0.0), (0.0, 0.2)]
    assert mechanics.strain(np.zeros(6), stretches, its) == pytest.approx(0.5 / np.sqrt(2.0))


def test_momentum_is_the_impulse_of_the_grips_over_a_run():
    result = simulate(carried("{kind: rigid, mass: 15.0}", simulator="{max_step_size: 0.002}", **UNLIKE))
    carrying = result.where(result["phase"] == 1, drop=True)
    impulse = -carrying["spring_force"].sum("robot").integrate("time")
    gained = 15.0 * (carrying["object_pose"][-1, 3:5] - carrying["object_pose"][0, 3:5])
    np.testing.assert_allclose(impulse, gained, atol=2e-3)
    assert np.abs(gained).max() > 0.5
    assert np.abs(carrying["object_pose"][:, 2]).max() > 0.01  # it turns, for the robots are not alike


@pytest.mark.parametrize(
    ("fields", "fault"),
    [
        ("mass: 100, friction: 0.5, grip_strength: 100", r"object.mass: its friction μ m g = 490.5 N .* 4 × 100 N"),
        ("mass: 100, friction: 0.5, grip_strength: 100", r"at most 81.55 kg, less friction, or stronger grips"),
        ("mass: 0", r"object.mass: out of range"),
        ("friction_speed: 0", r"object.friction_speed: out of range"),
        ("stiffness: 3", r"object.stiffness: unknown key"),
    ],
)
def test_what_it_cannot_be_is_refused_with_the_numbers(fields, fault):
    with pytest.raises(ScenarioError, match=fault):
        carried(f"{{kind: rigid, {fields}}}")


def test_what_its_grips_hold_is_taken():
    carried("{kind: rigid, mass: 81.5, friction: 0.5, grip_strength: 100}")


class Grips(LeafSystem):
    """Springs and dampers between the robots and points of a body of a MultibodyPlant, by its own kinematics."""

    def __init__(self, plant, slots, stiffness, damping):
        super().__init__()
        self._plant, self._context = plant, plant.CreateDefaultContext()
        self._slots, self._numbers = slots, (stiffness, damping)
        self._robots = [self.DeclareVectorInputPort(f"state_{j + 1}", 4) for j in range(len(slots))]
        self._state = self.DeclareVectorInputPort("body", 6)
        for j in range(len(slots)):
            self.DeclareVectorOutputPort(f"grip_force_{j + 1}", 2, self._calc_force(j))
        forces = Value[list[ExternallyAppliedSpatialForce]]
        self.DeclareAbstractOutputPort("forces", forces, self._calc_forces)

    def _force(self, context, j):
        self._plant.SetPositionsAndVelocities(self._context, self._state.Eval(context))
        body = self._plant.GetBodyByName("object")
        arm = np.array([*self._slots[j], 0.0])
        place = body.EvalPoseInWorld(self._context) @ arm
        speed = body.EvalSpatialVelocityInWorld(self._context)
        turned = body.EvalPoseInWorld(self._context).rotation() @ arm
        robot, (k, c) = self._robots[j].Eval(context), self._numbers
        return k * (place[:2] - robot[:2]) + c * (speed.Shift(turned).translational()[:2] - robot[2:])

    def _calc_force(self, j):
        return lambda context, output: output.SetFromVector(self._force(context, j))

    def _calc_forces(self, context, output):
        forces = []
        for j, slot in enumerate(self._slots):
            force = ExternallyAppliedSpatialForce()
            force.body_index = self._plant.GetBodyByName("object").index()
            force.p_BoBq_B = np.array([*slot, 0.0])
            force.F_Bq_W = SpatialForce(np.zeros(3), np.array([*-self._force(context, j), 0.0]))
            forces.append(force)
        output.set_value(forces)


class Idle(LeafSystem):
    """A strain that nobody asks for."""

    def __init__(self):
        super().__init__()
        self.DeclareVectorOutputPort("strain", 1, lambda context, output: None)


@pytest.fixture
def multibody():
    """The kind ``multibody``: a rigid object as Drake's MultibodyPlant has it, with a planar joint; nothing of ours."""

    class Multibody(Part):
        """A rigid body of Drake's."""

        Config = Rigid.Config

        def initial_state(self, formation, owner):
            return np.array([*formation.centre, 0.0, 0.0, 0.0, 0.0])

        def block(self, formation, owner, numbers):
            config, builder = self.config, DiagramBuilder()
            plant = builder.AddNamedSystem("plant", MultibodyPlant(0.0))
            inertia = SpatialInertia.MakeFromCentralInertia(config.mass, np.zeros(3), _about_z(config.inertia))
            thing = plant.AddRigidBody("object", inertia)
            plant.AddJoint(PlanarJoint("plane", plant.world_frame(), thing.body_frame()))
            plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
            plant.Finalize()
            numbers = config.grip_stiffness, config.grip_damping
            grips = builder.AddNamedSystem("grips", Grips(plant, formation.slots, *numbers))
            idle = builder.AddNamedSystem("idle", Idle())
            builder.Connect(plant.get_state_output_port(), grips.GetInputPort("body"))
            builder.Connect(grips.GetOutputPort("forces"), plant.get_applied_spatial_force_input_port())
            for j in range(formation.robots):
                builder.ExportInput(grips.GetInputPort(f"state_{j + 1}"), f"state_{j + 1}")
                builder.ExportOutput(grips.GetOutputPort(f"grip_force_{j + 1}"), f"grip_force_{j + 1}")
            builder.ExportOutput(plant.get_state_output_port(), "pose")
            builder.ExportOutput(idle.GetOutputPort("strain"), "strain")
            return builder.Build()

    known = {role: dict(its) for role, its in registry._parts.items()}
    yield register(part("object", kind="multibody")(Multibody))
    registry._parts.update(known)
    registry._told()


def _about_z(inertia):
    from pydrake.multibody.tree import RotationalInertia

    return RotationalInertia(inertia, inertia, inertia)


@pytest.mark.usefixtures("multibody")
def test_drakes_multibody_plant_moves_the_same_way():
    fields = "mass: 30, inertia: 6, grip_stiffness: 5.0e3, grip_damping: 150"
    lines = UNLIKE | {"aggregation": "{duration: 0}", "simulator": "{accuracy: 1.0e-10}"}
    lines["transport"] = "{goal: [4.0, 3.5], duration: 1.0}"
    ours, theirs = (
        simulate(carried(f"{{kind: {kind}, {fields}}}", **lines), engine="blocks") for kind in ("rigid", "multibody")
    )
    for name in ("position", "object_pose"):
        np.testing.assert_allclose(ours[name].values[-1], theirs[name].values[-1], rtol=0, atol=1e-6)
    assert np.abs(ours["object_pose"].values[-1, 2]) > 1e-3
