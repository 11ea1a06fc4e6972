from contextlib import nullcontext

import numpy as np
import pytest
from pydrake.systems.framework import EventStatus

from drake_formation.diagram import build_diagram
from drake_formation.scenario import load_scenario
from drake_formation.simulation.recorder import RECORDED, BeyondBoundsError, NonFiniteStateError, Recorder


@pytest.fixture
def diagram():
    return build_diagram(load_scenario("line"))


@pytest.fixture
def context(diagram):
    return diagram.CreateDefaultContext()


def test_a_sample_holds_what_the_ports_show(diagram, context):
    recorder = Recorder(diagram, 2)
    recorder(context)
    for name in RECORDED:
        shown = [diagram.GetOutputPort(f"robot_{i}_{name}").Eval(context) for i in (1, 2)]
        np.testing.assert_array_equal(recorder.series(name), [shown])
    assert recorder.phases.tolist() == [0]


def test_samples_are_copies(diagram, context):
    recorder = Recorder(diagram, 2)
    recorder(context)
    before = recorder.series("state").copy()
    context.SetTime(1.0)
    context.SetContinuousState(np.ones(8))
    recorder(context)
    np.testing.assert_array_equal(recorder.series("state")[:1], before)
    np.testing.assert_array_equal(recorder.series("state")[1], np.ones((2, 4)))


def test_a_second_sample_at_the_same_time_replaces_the_first(diagram, context):
    recorder = Recorder(diagram, 2)
    for value in (1.0, 2.0):
        context.SetContinuousState(np.full(8, value))
        recorder(context)
    assert recorder.times.tolist() == [0]
    np.testing.assert_array_equal(recorder.series("state"), np.full((1, 2, 4), 2.0))


@pytest.mark.parametrize("value", [np.inf, np.nan])
def test_a_state_that_is_not_finite_is_not_kept(diagram, context, value):
    recorder = Recorder(diagram, 2)
    recorder(context)
    context.SetTime(1.0)
    context.SetContinuousState([value, *np.ones(7)])
    with pytest.raises(NonFiniteStateError):
        recorder(context)
    assert recorder.times.tolist() == [0]


def test_a_state_beyond_the_farthest_is_not_kept(diagram, context):
    recorder = Recorder(diagram, 2, farthest=100.0)
    for last, kept in ((100.0, True), (-100.1, False)):
        context.SetTime(abs(last))
        context.SetContinuousState([last, *np.ones(7)])
        with nullcontext() if kept else pytest.raises(BeyondBoundsError):
            recorder(context)
    assert recorder.times.tolist() == [100.0]


def test_an_empty_record_has_the_shape_of_none(diagram):
    recorder = Recorder(diagram, 2)
    assert recorder.times.shape == (0,)
    assert recorder.series("state").shape == (0, 2, 4)
    assert recorder.series("tracking_force").shape == (0, 2, 2)


def test_progress_hears_of_every_sample(diagram, context):
    heard = []
    recorder = Recorder(diagram, 2, heard.append)
    for time in (0.0, 0.5, 2.0):
        context.SetTime(time)
        status = recorder(context)
    assert heard == [0.0, 0.5, 2.0]
    assert status.severity() == EventStatus.DidNothing().severity()
