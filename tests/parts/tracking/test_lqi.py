import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Adder, ConstantVectorSource
from scipy.linalg import solve_continuous_are
from strategies import cost, generators
from tracking_loops import apart, two

from drake_formation import ScenarioError
from drake_formation.analysis import IllPosedError, certify
from drake_formation.parts.robots.point_mass import RobotPlant
from drake_formation.parts.springs.hookean import Hookean
from drake_formation.parts.tracking.controller import TrackingController
from drake_formation.parts.tracking.integral_controller import IntegralController
from drake_formation.parts.tracking.lqi import augmented_matrices, lqi_gain
from drake_formation.parts.tracking.lqr import lqr_force, lqr_gain

masses = st.floats(0.1, 1000)


@given(masses, generators)
@settings(max_examples=30)
def test_gain_solves_the_riccati_equation_of_the_augmented_system(mass, rng):
    a, b = augmented_matrices(mass)
    q, r = np.array(cost(rng, 6, isotropic=False)), np.array(cost(rng, 2, isotropic=False))
    expected = np.linalg.solve(r, b.T @ solve_continuous_are(a, b, q, r))
    found = lqi_gain(mass, q, r)
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-6 * abs(expected).max())
    assert np.linalg.eigvals(a - b @ found).real.max() < 0


def test_the_integral_of_the_error_is_what_the_block_remembers():
    block = IntegralController(np.zeros((2, 6)), [0.0], [0.5, -0.5])
    context = block.CreateDefaultContext()
    block.GetInputPort("state").FixValue(context, [3.0, 1.0, 9.0, 9.0])
    block.GetInputPort("reference").FixValue(context, [1.0, 2.0, 0.0, 0.0, 0.0, 0.0])
    assert block.EvalTimeDerivatives(context).CopyToVector().tolist() == [1.5, -0.5]


def disturbed_end(controller, disturbance):
    """Where a robot under a constant force comes to rest, whose reference is the origin (m)."""
    builder = DiagramBuilder()
    plant = builder.AddSystem(RobotPlant([], Hookean, [40.0], np.zeros((0, 4)), [1.0, 0.0, 0.0, 0.0]))
    controller = builder.AddSystem(controller)
    total = builder.AddSystem(Adder(2, 2))
    wind, reference, phase = (
        builder.AddSystem(ConstantVectorSource(value)) for value in (disturbance, np.zeros(6), [1.0])
    )
    builder.Connect(controller.GetOutputPort("force"), total.get_input_port(0))
    builder.Connect(wind.get_output_port(), total.get_input_port(1))
    builder.Connect(total.get_output_port(), plant.GetInputPort("force"))
    builder.Connect(phase.get_output_port(), plant.GetInputPort("phase"))
    builder.Connect(plant.GetOutputPort("state"), controller.GetInputPort("state"))
    builder.Connect(reference.get_output_port(), controller.GetInputPort("reference"))
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(120.0)
    return plant.GetMyContextFromRoot(simulator.get_context()).get_continuous_state_vector().CopyToVector()[:2]


def test_a_constant_force_leaves_no_steady_error_where_the_lqr_has_one():
    disturbance = np.array([3.0, -2.0])
    gain = lqi_gain(40.0, np.diag([10.0, 10.0, 1.0, 1.0, 1.0, 1.0]), np.eye(2))
    with_integral = disturbed_end(IntegralController(gain, [0.0], [0.0, 0.0]), disturbance)
    np.testing.assert_allclose(with_integral, 0.0, atol=1e-6)
    plain = lqr_gain(40.0, np.diag([10.0, 10.0, 1.0, 1.0]), np.eye(2))
    without = disturbed_end(TrackingController(lqr_force, [plain, [0.0]], [0.0, 0.0]), disturbance)
    np.testing.assert_allclose(without, disturbance / np.sqrt(10.0), atol=1e-6)


@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    assert apart(engine, kind="lqi", Q=[100.0, 100.0, 1.0, 1.0, 10.0, 10.0], feed_forward=True) < 1e-4


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        ([1.0] * 4, "tracking.Q: a diagonal of 4 entries, not 6"),
        ([1.0, 1.0, 1.0, 1.0, 0.0, 1.0], "tracking.Q: a position integral costs nothing"),
        ([1.0, 1.0, 1.0, 1.0, 1.0, -1.0], "tracking.Q: not positive semi-definite"),
    ],
)
def test_weights_without_a_gain_are_refused(weights, message):
    with pytest.raises(ScenarioError, match=message):
        two(kind="lqi", Q=weights)


def test_the_analysis_refuses_it_by_name():
    with pytest.raises(IllPosedError, match="tracking 'lqi' of drake-formation"):
        certify(two(kind="lqi"))
