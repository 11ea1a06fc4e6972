"""Ticks are counted: none is missed and none comes twice."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Integrator, Sine, ZeroOrderHold

from drake_formation.lowering import lower
from drake_formation.lowering.ticks import Ticks

periods = st.floats(1e-3, 10)
offsets = st.floats(0, 10)


@given(periods, offsets, st.lists(st.floats(0, 1), max_size=30))
@example(0.1, 0.03, [0.33])
def test_every_tick_is_met_once_wherever_one_stops(period, offset, shares):
    end = offset + 20.5 * period
    stops = sorted([*(share * end for share in shares), end])
    ticks, time, met = Ticks(offset, period), -1.0, []
    for stop in stops:
        while time < stop:
            time = min(stop, ticks.after(time))
            if ticks.is_one(time):
                met.append(time)
    assert met == [offset + k * period for k in range(21)]


@given(periods, offsets, st.integers(0, 1000))
def test_a_tick_is_one_and_its_neighbours_are_none(period, offset, count):
    tick = offset + count * period
    ticks = Ticks(offset, period)
    assert ticks.is_one(tick)
    assert not ticks.is_one(np.nextafter(tick, np.inf))
    assert ticks.after(np.nextafter(tick, -np.inf)) == tick


@pytest.mark.parametrize("stops", [[1.0], [0.33, 1.0], [0.23, 0.33, 0.5, 1.0]])
@pytest.mark.parametrize("method", ["dormand_prince", "exponential"])
def test_a_hold_that_drake_lets_pass_is_carried_out(stops, method):
    """Period 0.1 and offset 0.03: Drake's Simulator leaves out the update at 0.33 and ends 9.6 mm off."""
    builder = DiagramBuilder()
    source, hold = builder.AddSystem(Sine(1.0, 1.0, 0.0, 1)), builder.AddSystem(ZeroOrderHold(0.1, 1, 0.03))
    total = builder.AddSystem(Integrator(1))
    builder.Connect(source.get_output_port(0), hold.get_input_port())
    builder.Connect(hold.get_output_port(), total.get_input_port())
    diagram = builder.Build()
    compiled, context = lower(diagram), diagram.CreateDefaultContext()
    for stop in stops:
        list(compiled.integrate(context, stop, method=method))
    held = [0.03 + 0.1 * k for k in range(10)]
    exact = sum(np.sin(time) * min(0.1, 1.0 - time) for time in held)
    assert context.get_continuous_state_vector().GetAtIndex(0) == pytest.approx(exact, abs=1e-12)
