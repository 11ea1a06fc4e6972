"""References compared on one formation."""

from drake_formation.paper.trajectories import REFERENCES, referenced, s_curve


def test_the_compared_runs_differ_in_the_reference_alone():
    base = referenced("set point")
    for name in REFERENCES:
        run = referenced(name)
        same = {"transport": base.transport, "tracking": base.tracking}
        assert run.model_copy(update=same) == base


def test_the_s_curve_ships():
    assert s_curve().transport.reference.kind == "waypoints"
