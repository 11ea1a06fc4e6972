"""When Drake changes discrete state between two integrations, and what is refused."""

import itertools

import numpy as np
import pytest
from pydrake.common import RandomDistribution
from pydrake.common.value import Value
from pydrake.systems.framework import DiagramBuilder, LeafSystem
from pydrake.systems.primitives import DiscreteDerivative, Gain, RandomSource, ZeroOrderHold

from drake_formation import build_diagram, load_scenario
from drake_formation.lowering import LoweringError
from drake_formation.lowering.events import Updates
from drake_formation.lowering.wiring import Wiring


def updates_of(*blocks):
    builder = DiagramBuilder()
    for k, block in enumerate(blocks):
        builder.AddNamedSystem(f"block_{k}", block)
        for port in range(block.num_input_ports()):
            builder.ExportInput(block.get_input_port(port), f"u_{k}_{port}")
    diagram = builder.Build()
    return Updates(Wiring(diagram)), diagram


def test_the_next_update_of_any_block_is_next():
    updates, _ = updates_of(ZeroOrderHold(0.5, 1), ZeroOrderHold(0.3, 1))
    times, now = [], 0.0
    while now < 1.2:
        now = updates.after(now, 1.2)
        times.append(now)
    np.testing.assert_allclose(times, [0.3, 0.5, 0.6, 0.9, 1.0, 1.2])


def test_without_updates_nothing_stands_before_the_end():
    updates, diagram = updates_of(Gain(1.0, 1))
    assert updates.after(0.0, 7.0) == 7.0
    updates.carry_out(diagram.CreateDefaultContext())


def test_the_hand_off_is_carried_out():
    diagram = build_diagram(load_scenario("line"))
    updates = Updates(Wiring(diagram))
    context = diagram.CreateDefaultContext()
    assert updates.after(0.0, 120.0) == 60.0
    context.SetTime(60.0)
    updates.carry_out(context)
    assert diagram.GetOutputPort("phase").Eval(context) == [1.0]


class Abstract(LeafSystem):
    """Holds something that is no number."""

    def __init__(self):
        super().__init__()
        self.DeclareAbstractState(Value("text"))


def test_abstract_state_is_refused_by_name():
    with pytest.raises(LoweringError, match=r"'block_0'.*abstract state"):
        updates_of(Abstract())


def test_any_single_periodic_update_is_carried_out():
    updates, _ = updates_of(DiscreteDerivative(1, 0.25))
    assert updates.after(0.0, 1.0) == 0.25


def test_updates_at_one_time_see_what_was_there_before_any_of_them():
    """A shift register: each hold takes what the one before it held."""
    builder = DiagramBuilder()
    holds = [builder.AddNamedSystem(f"hold_{k}", ZeroOrderHold(0.1, 1)) for k in range(3)]
    for earlier, later in itertools.pairwise(holds):
        builder.Connect(earlier.get_output_port(), later.get_input_port())
    builder.ExportInput(holds[0].get_input_port(), "u")
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    diagram.get_input_port(0).FixValue(context, [7.0])
    updates = Updates(Wiring(diagram))
    for count in range(1, 4):
        context.SetTime(0.1 * (count - 1))
        updates.carry_out(context)
        assert [hold.get_output_port().Eval(hold.GetMyContextFromRoot(context))[0] for hold in holds] == [
            7.0 if k < count else 0.0 for k in range(3)
        ]


class Parametrized(LeafSystem):
    """Has a parameter that is no number."""

    def __init__(self):
        super().__init__()
        self.DeclareAbstractParameter(Value("text"))


def test_abstract_parameters_are_refused_by_name():
    with pytest.raises(LoweringError, match=r"'block_0'.*abstract parameters"):
        updates_of(Parametrized())


def test_a_random_source_is_refused_by_name():
    with pytest.raises(LoweringError, match=r"'block_0'.*abstract state"):
        updates_of(RandomSource(RandomDistribution.kUniform, 1, 0.1))
