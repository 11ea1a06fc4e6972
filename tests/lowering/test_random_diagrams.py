"""A law of the compiler: whatever a diagram is made of, compiled runs do what Drake's Simulator does, or refuse it."""

import re
from contextlib import contextmanager
from functools import cache as remembered
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

from drake_formation import machine_code
from drake_formation.lowering import LoweringError, integration, lower
from drake_formation.lowering.integration import METHODS
from tests.lowering.random_diagrams import example

BEGIN, END = 0.25, 1.53
"""No tick is at the end, where Drake and a compiled run would leave it for the next."""

NO_COMPILER = """
def njit(*arguments, **_):
    return arguments[0] if arguments and callable(arguments[0]) else lambda function: function
"""


@remembered
def interpreted(source):
    """A module of the compiler's, read by Python: the same text, without waiting for machine code."""
    text = re.sub(r"from numba import njit(, types)?", lambda match: f"from numba import types{NO_COMPILER}", source)
    module = ModuleType("interpreted")
    exec(compile(text, "interpreted", "exec"), vars(module))
    return module


@contextmanager
def without_compiler():
    integration._compiled.cache_clear()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(machine_code, "load", interpreted)
        yield
    integration._compiled.cache_clear()


def context_of(diagram, seed):
    """A Context in which everything that can be set is not at its default."""
    rng = np.random.default_rng([seed, 1])
    context = diagram.CreateDefaultContext()
    context.SetTime(BEGIN)
    context.SetContinuousState(rng.uniform(-1, 1, context.num_continuous_states()))
    for k in range(context.num_discrete_state_groups()):
        context.SetDiscreteState(k, rng.uniform(-1, 1, context.get_discrete_state().get_vector(k).size()))
    for k in range(context.num_numeric_parameter_groups()):
        group = context.get_mutable_numeric_parameter(k)
        group.SetFromVector(group.CopyToVector() * rng.uniform(0.8, 1.2, group.size()))
    for k in range(diagram.num_input_ports()):
        port = diagram.get_input_port(k)
        port.FixValue(context, rng.uniform(-1, 1, port.size()))
    return context


def everything(diagram, context, logs):
    """All numbers that a run leaves behind, and its logs' times."""
    discrete = [
        context.get_discrete_state().get_vector(k).CopyToVector() for k in range(context.num_discrete_state_groups())
    ]
    output = diagram.GetOutputPort("y").Eval(context)
    records = [log.FindLog(context) for log in logs]
    numbers = [context.get_continuous_state_vector().CopyToVector(), *discrete, output]
    return np.concatenate(numbers), [(record.sample_times().copy(), record.data().copy()) for record in records]


def simulated(diagram, context, logs):
    simulator = Simulator(diagram, context)
    integrator = ResetIntegratorFromFlags(simulator, "runge_kutta3", 0.02)
    integrator.set_target_accuracy(1e-9)
    simulator.AdvanceTo(END)
    return everything(diagram, simulator.get_context(), logs)


def compiled_run(compiled, context, logs, method, stops):
    for stop in stops:
        *_, last = compiled.integrate(context, stop, method=method, accuracy=1e-9, max_step=0.05)
    assert last.status == 0
    return everything(compiled.diagram, context, logs)


def same(found, expected):
    (numbers, logs), (others, other_logs) = found, expected
    np.testing.assert_allclose(numbers, others, rtol=2e-6, atol=2e-6)
    for (times, data), (other_times, other_data) in zip(logs, other_logs, strict=True):
        np.testing.assert_array_equal(times, other_times)
        np.testing.assert_allclose(data, other_data, rtol=2e-6, atol=2e-6)


def holds(seed):
    """A diagram runs as in Drake; or it is refused, and then by the name of a block that has what is refused."""
    drawn = example(seed)
    if drawn.refused:
        with pytest.raises(LoweringError) as refusal:
            lower(drawn.diagram)
        assert refusal.value.block in drawn.refused
        return
    compiled = lower(drawn.diagram)
    expected = simulated(drawn.diagram, context_of(drawn.diagram, seed), drawn.logs)
    for method, stops in zip(METHODS, ([END], [0.5, 1.0, END]), strict=True):
        same(compiled_run(compiled, context_of(drawn.diagram, seed), drawn.logs, method, stops), expected)


@pytest.mark.slow
@settings(max_examples=300, deadline=None, derandomize=True, database=None)
@given(st.integers(0, 2**32 - 1))
def test_a_compiled_run_does_what_drakes_simulator_does_or_is_refused_by_name(seed):
    with without_compiler():
        holds(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_so_it_is_in_machine_code(seed):
    holds(seed)


def test_most_examples_are_to_be_compiled():
    refused = [bool(example(seed).refused) for seed in range(200)]
    assert 10 <= sum(refused) <= 50
