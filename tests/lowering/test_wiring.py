"""A nested diagram without its nesting."""

from hypothesis import HealthCheck, given, settings
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Adder, Gain
from strategies import scenarios

from drake_formation import build_diagram
from drake_formation.lowering.wiring import Wiring


def nested():
    """A gain within two diagrams, fed from outside and feeding an adder beside the inner one."""
    innermost = DiagramBuilder()
    gain = innermost.AddNamedSystem("gain", Gain(2.0, 1))
    innermost.ExportInput(gain.get_input_port(), "u")
    innermost.ExportOutput(gain.get_output_port(), "y")
    inner = DiagramBuilder()
    deep = inner.AddNamedSystem("deep", innermost.Build())
    inner.ExportInput(deep.get_input_port(), "u")
    inner.ExportOutput(deep.get_output_port(), "y")
    outer = DiagramBuilder()
    shallow = outer.AddNamedSystem("shallow", inner.Build())
    both = outer.AddNamedSystem("both", Adder(2, 1))
    outer.ExportInput(shallow.get_input_port(), "u")
    outer.Connect(shallow.get_output_port(), both.get_input_port(0))
    outer.Connect(shallow.get_output_port(), both.get_input_port(1))
    return outer.Build(), gain, both


def test_sources_are_found_through_all_levels():
    diagram, gain, both = nested()
    wiring = Wiring(diagram)
    assert list(wiring.blocks) == ["shallow/deep/gain", "both"]
    assert wiring.source(both, 0) == wiring.source(both, 1) == (gain, 0)
    assert wiring.source(gain, 0) is None


@given(scenario=scenarios())
@settings(max_examples=5, deadline=None, suppress_health_check=list(HealthCheck))
def test_every_input_of_a_formation_has_a_source(scenario):
    wiring = Wiring(build_diagram(scenario))
    for path, block in wiring.blocks.items():
        for port in range(block.num_input_ports()):
            assert wiring.source(block, port) is not None, path
