"""When Drake changes discrete state between two integrations, and what is refused."""

import numpy as np
import pytest
from pydrake.common.value import Value
from pydrake.systems.framework import DiagramBuilder, LeafSystem
from pydrake.systems.primitives import DiscreteDerivative, Gain, ZeroOrderHold

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
    return Updates(diagram, Wiring(diagram)), diagram


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
    updates = Updates(diagram, Wiring(diagram))
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
