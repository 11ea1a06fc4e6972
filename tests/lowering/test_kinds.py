"""Blocks of one kind compute the same."""

from hypothesis import HealthCheck, given, settings
from strategies import scenarios

from drake_formation import build_diagram
from drake_formation.lowering.kinds import KindTable
from drake_formation.lowering.trace import DERIVATIVES, SymbolTable, TracedBlock
from drake_formation.lowering.wiring import Wiring


@given(scenario=scenarios())
@settings(max_examples=10, deadline=None, suppress_health_check=list(HealthCheck))
def test_blocks_that_promise_to_be_of_one_kind_trace_alike(scenario):
    symbols, kinds, checked = SymbolTable(), KindTable(), 0
    for path, block in Wiring(build_diagram(scenario)).blocks.items():
        traced = TracedBlock(path, block, symbols)
        functions = [*range(block.num_output_ports()), *([DERIVATIVES] if traced.sizes[1] else [])]
        for function in functions:
            kind = kinds.find(traced, function)
            if getattr(block, "kind", None) is not None:
                expressions = traced.trace(function)
                (same,) = [
                    k
                    for others, k in kinds._traced[type(block), traced.sizes, function]
                    if all(a.EqualTo(b) for a, b in zip(others, expressions, strict=True))
                ]
                assert same is kind, path
                checked += 1
    assert checked
