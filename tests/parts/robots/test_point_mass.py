import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import gains, metres, speeds

from drake_formation.parts import kinds
from drake_formation.parts.robots.point_mass import RobotPlant
from drake_formation.parts.springs.hookean import hookean_spring_force
from drake_formation.parts.springs.linear import Linear, linear_spring_force

laws = pytest.mark.parametrize("law", [part.law for part in kinds("spring").values()], ids=kinds("spring"))
relative = st.tuples(metres, metres, speeds, speeds).filter(lambda x: np.hypot(x[0], x[1]) > 0.1)
displacements = st.tuples(metres, metres).filter(lambda h: np.hypot(*h) > 0.1)


@laws
@given(x=relative, k=gains, c=gains, h=displacements)
def test_springs_pull_both_ends_alike(law, x, k, c, h):
    one = law(*x, k, c, *h)
    other = law(*np.negative(x).tolist(), k, c, *np.negative(h).tolist())
    assert one == tuple(-f for f in other)


@laws
@given(k=gains, c=gains, h=displacements)
def test_springs_rest_at_the_slot_displacement(law, k, c, h):
    assert law(*h, 0.0, 0.0, k, c, *h) == pytest.approx((0.0, 0.0), abs=1e-11)


@given(relative, gains, gains, displacements)
def test_a_hookean_spring_exerts_no_torque(x, k, c, h):
    dx, dy, *_ = x
    fx, fy = hookean_spring_force(*x, k, c, *h)
    assert dx * fy - dy * fx == pytest.approx(0, abs=1e-12 * (1 + np.hypot(fx, fy)) * 10)


@given(displacements, st.floats(-np.pi, np.pi), gains)
def test_a_hookean_spring_lets_its_pair_rotate(h, angle, k):
    dx, dy = rotated(h, angle)
    assert hookean_spring_force(dx, dy, 0.0, 0.0, k, 0.0, *h) == pytest.approx((0, 0), abs=1e-9)


@given(displacements, st.floats(0.1, 3.0), st.floats(1, 1e4))
def test_a_linear_spring_turns_its_pair_back(h, angle, k):
    dx, dy = rotated(h, angle)
    fx, fy = linear_spring_force(dx, dy, 0.0, 0.0, k, 0.0, *h)
    # Robot i feels −F: the torque on the pair is against the rotation.
    assert -(dx * fy - dy * fx) == pytest.approx(-k * np.dot(h, h) * np.sin(angle), rel=1e-9)


@given(displacements, st.floats(-0.5, 1.0), gains)
def test_both_laws_agree_along_the_line(h, stretch, k):
    dx, dy = (1 + stretch) * np.array(h)
    along = float(dx), float(dy), 0.0, 0.0
    expected = k * stretch * np.array(h)
    assert hookean_spring_force(*along, k, 0.0, *h) == pytest.approx(expected, abs=1e-8)
    assert linear_spring_force(*along, k, 0.0, *h) == pytest.approx(expected, abs=1e-8)


@given(relative, gains, displacements)
def test_hookean_force_is_equation_2(x, k, h):
    dx, dy, *_ = x
    factor = k * (1 - np.hypot(*h) / np.hypot(dx, dy))
    assert hookean_spring_force(*x, k, 0.0, *h) == pytest.approx((factor * dx, factor * dy), rel=1e-9, abs=1e-8)


@laws
@given(x=relative, c=gains, h=displacements)
def test_damping_takes_energy_away(law, x, c, h):
    _, _, dvx, dvy = x
    fx, fy = law(*x, 0.0, c, *h)
    assert fx * dvx + fy * dvy >= 0


@given(relative, gains, displacements)
def test_a_hookean_damper_resists_the_rate_of_the_length(x, c, h):
    dx, dy, dvx, dvy = x
    length, step = np.hypot(dx, dy), 1e-6
    rate = (np.hypot(dx + step * dvx, dy + step * dvy) - np.hypot(dx - step * dvx, dy - step * dvy)) / (2 * step)
    expected = c * rate * np.array([dx, dy]) / length
    assert hookean_spring_force(*x, 0.0, c, *h) == pytest.approx(expected, rel=1e-6, abs=1e-8 * c + 1e-9)


@given(relative, st.floats(1, 1e4), displacements)
def test_a_hookean_damper_acts_on_the_change_of_length_alone(x, c, h):
    dx, dy, *_ = x
    across = -dy, dx
    assert hookean_spring_force(dx, dy, *across, 0.0, c, *h) == pytest.approx((0, 0), abs=1e-9)


def rotated(vector, angle):
    x, y = vector
    return x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)


@pytest.fixture
def plant():
    return RobotPlant([2], Linear, [40.0], [[10.0, 0.0, 0.0, -1.0]], [1.0, 2.0, 3.0, 4.0])


@pytest.mark.parametrize("phase", [0.0, 1.0])
def test_the_plant_obeys_newton(plant, phase):
    context = plant.CreateDefaultContext()
    plant.GetInputPort("force").FixValue(context, [4.0, -8.0])
    plant.GetInputPort("phase").FixValue(context, [phase])
    plant.GetInputPort("spring_2").FixValue(context, [1.5, 2.0, 0.0, 0.0])
    # Robot 1 is 0.5 m left of robot 2 and 1 m above its slot displacement.
    spring = phase * np.array([5.0, -10.0])
    np.testing.assert_allclose(plant.GetOutputPort("spring_force").Eval(context), spring)
    derivatives = plant.EvalTimeDerivatives(context).CopyToVector()
    np.testing.assert_allclose(derivatives, [3.0, 4.0, *((np.array([4.0, -8.0]) + spring) / 40)])


def test_the_plant_starts_at_its_initial_state(plant):
    context = plant.CreateDefaultContext()
    assert plant.GetOutputPort("state").Eval(context).tolist() == [1.0, 2.0, 3.0, 4.0]


def test_the_plants_state_splits_into_positions_and_velocities(plant):
    state = plant.CreateDefaultContext().get_continuous_state()
    assert state.get_generalized_position().CopyToVector().tolist() == [1.0, 2.0]
    assert state.get_generalized_velocity().CopyToVector().tolist() == [3.0, 4.0]
