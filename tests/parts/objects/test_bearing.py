import numpy as np
import pytest

from drake_formation.parts.objects.bearing import GripsBear, SpringsBear
from drake_formation.parts.springs.hookean import Hookean
from drake_formation.parts.springs.linear import Linear


@pytest.mark.parametrize("law", [Hookean, Linear])
def test_bounds_are_of_strain_and_of_force(law):
    judge = SpringsBear(law, ((0, 1),), False)
    states = [[1.2, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]]
    spring = np.array([100.0, 0.0, 1.0, 0.0])  # 20 % longer than at rest, which takes 20 N
    for bounds, intact in (([0.21, np.inf], 1), ([0.19, np.inf], 0), ([np.inf, 21.0], 1), ([np.inf, 19.0], 0)):
        assert judge(states, [spring, np.array(bounds)]) == [intact]
    shorter = [[0.8, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]]
    assert judge(shorter, [spring, np.array([0.19, np.inf])]) == [0]
    let_go = SpringsBear(law, ((0, 1),), True)
    assert let_go([*states, [0.0]], [spring, np.array([0.1, 1.0])]) == [1]


def test_grips_bear_forces_of_any_direction_up_to_their_bound():
    assert GripsBear()([[3.0, -4.0], [3.0, -4.0]], [np.array([5.0, 4.9])]) == [1, 0]
