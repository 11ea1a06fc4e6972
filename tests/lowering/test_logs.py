"""Drake's logs record in a compiled run when the Simulator would let them."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder, TriggerType
from pydrake.systems.primitives import Integrator, LogVectorOutput, Sine, VectorLogSink

from drake_formation import build_diagram, load_scenario
from drake_formation.lowering import LoweringError, lower


def logged_sine(*log_arguments):
    builder = DiagramBuilder()
    source, total = builder.AddSystem(Sine(1.0, 2.0, 0.0, 1)), builder.AddSystem(Integrator(1))
    builder.Connect(source.get_output_port(0), total.get_input_port())
    log = LogVectorOutput(total.get_output_port(), builder, *log_arguments)
    return builder.Build(), log


@pytest.mark.parametrize("period", [0.5, 0.3, 1e-3, 100.0])
def test_a_log_holds_what_drake_lets_it_hold(period):
    diagram, log = logged_sine(period)
    context = diagram.CreateDefaultContext()
    for stop in (0.7, 2.0):
        list(lower(diagram).integrate(context, stop))
    simulator = Simulator(diagram)
    simulator.AdvanceTo(2.0)
    found, expected = log.FindLog(context), log.FindLog(simulator.get_context())
    np.testing.assert_allclose(found.sample_times(), expected.sample_times(), atol=1e-12)
    np.testing.assert_allclose(found.data(), expected.data(), atol=1e-4)


def test_a_log_around_a_formation_holds_thirteen_samples_in_six_seconds():
    scenario = load_scenario("line", overrides={"aggregation.duration": 3.0, "transport.duration": 3.0})
    builder = DiagramBuilder()
    formation = builder.AddSystem(build_diagram(scenario))
    log = LogVectorOutput(formation.GetOutputPort("robot_1_state"), builder, 0.5)
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    list(lower(diagram).integrate(context, 6.0))
    np.testing.assert_allclose(log.FindLog(context).sample_times(), 0.5 * np.arange(13))
    np.testing.assert_array_equal(log.FindLog(context).data()[:, 0], [4, 5, 0, 0])


@pytest.mark.parametrize("method", ["dormand_prince", "exponential"])
def test_a_log_of_every_step_holds_every_sample(method):
    diagram, log = logged_sine()
    context = diagram.CreateDefaultContext()
    times = np.concatenate([piece.times for piece in lower(diagram).integrate(context, 1.0, method=method)])
    np.testing.assert_array_equal(log.FindLog(context).sample_times(), [0.0, *times])


def test_a_log_that_records_when_told_alone_stays_empty():
    diagram, log = logged_sine({TriggerType.kForced}, 0.0)
    context = diagram.CreateDefaultContext()
    list(lower(diagram).integrate(context, 1.0))
    assert log.FindLog(context).num_samples() == 0


def test_a_log_that_cannot_be_told_to_record_is_refused_by_name():
    builder = DiagramBuilder()
    source = builder.AddSystem(Sine(1.0, 2.0, 0.0, 1))
    sink = VectorLogSink(1, publish_triggers={TriggerType.kPeriodic}, publish_period=0.5)
    log = builder.AddNamedSystem("stubborn", sink)
    builder.Connect(source.get_output_port(0), log.get_input_port())
    with pytest.raises(LoweringError, match=r"'stubborn'.*log that cannot be told"):
        lower(builder.Build())
