"""The yardstick of the benchmarks computes what the real blocks compute."""

import numpy as np
import pytest
from benchmarks.naive import naive_diagram

from drake_formation import build_diagram, load_scenario


@pytest.mark.parametrize("name", ["line", "octagon"])
def test_naive_blocks_give_the_same_derivatives(name):
    overrides = {"aggregation.duration": 0, "robots.start": {"centre": [5.5, 3.5]}, "consensus.delta": 10.0}
    scenario = load_scenario(name, overrides=overrides)
    naive = naive_diagram(scenario)
    slopes = []
    for diagram in (naive, build_diagram(scenario)):
        context = diagram.CreateDefaultContext()
        state = context.get_continuous_state_vector().CopyToVector()
        context.SetContinuousState(state + 0.1 * np.random.default_rng(0).normal(size=len(state)))
        slopes.append(diagram.EvalTimeDerivatives(context).CopyToVector())
    np.testing.assert_allclose(*slopes, rtol=1e-9, atol=1e-12)
