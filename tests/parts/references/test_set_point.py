import pytest

from drake_formation.parts.references.set_point import SetPoint


@pytest.mark.parametrize(("phase", "expected"), [(0.0, [2.5, 3.5]), (1.0, [25.0, 3.7])])
def test_the_reference_is_at_rest_at_the_centre_and_then_at_the_goal(phase, expected):
    reference = SetPoint([2.5, 3.5], [25.0, 3.7])
    context = reference.CreateDefaultContext()
    reference.GetInputPort("phase").FixValue(context, [phase])
    motion = reference.GetOutputPort("centre").Eval(context)
    assert motion[:2].tolist() == expected
    assert not motion[2:].any()
