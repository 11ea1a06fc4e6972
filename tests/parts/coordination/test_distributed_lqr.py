"""The distributed LQR as a part: what the analysis designs, in the diagram."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.systems.primitives import Linearize
from strategies import cost, generators

from drake_formation import ScenarioError, build_diagram, load_scenario, set_parameters, simulate, with_overrides
from drake_formation.analysis import IllPosedError, at_rest, distributed_lqr, linearize
from drake_formation.parameters import block_parameters
from drake_formation.parts.coordination.centralized_lqr import centralized_gains
from drake_formation.parts.coordination.distributed_lqr import designed
from drake_formation.scenario import resolve

CONNECTED = [g for g in nx.graph_atlas_g() if 2 <= g.number_of_nodes() <= 4 and nx.is_connected(g)]
SHORT = {"aggregation.duration": 0.5, "transport.duration": 1.0, "simulator.accuracy": 1e-9}


def on_graph(graph, **weights):
    """Robots in a row, as many as the graph has nodes, under the distributed LQR along its edges."""
    edges = [[i + 1, j + 1] for i, j in graph.edges]
    fixed = {
        "formation": {"shape": "line", "robots": graph.number_of_nodes(), "side": 0.5},
        "robots.start": {"centre": [2.5, 3.5]},
        "springs.stiffness": 100.0,
        "tracking": {"kind": "none"},
        "consensus": {"kind": "distributed_lqr", "graph": edges, **weights},
    }
    return load_scenario("line", overrides=fixed)


def judged(scenario):
    """The analysis of the same graph, weights and springs, and its closed loop by its own matrices."""
    chosen = scenario.consensus
    tracking = {"Q": chosen.Q, "R": chosen.R}
    formation = linearize(with_overrides(scenario, {"tracking": tracking, "consensus": {"graph": chosen.graph}}))
    found = distributed_lqr(formation, relative_cost=chosen.relative_cost, scale=chosen.scale)
    force = formation.B[:4, :2]
    return found, formation.tracking + formation.springs - np.kron(formation.laplacian, force @ found.K2)


def loop_of(scenario):
    diagram = build_diagram(at_rest(scenario))
    return Linearize(diagram, diagram.CreateDefaultContext()).A()


@given(graph=st.sampled_from(CONNECTED), rng=generators)
@settings(max_examples=10)
def test_the_diagram_is_the_loop_that_the_analysis_judges(graph, rng):
    scenario = on_graph(graph, Q=cost(rng, 4, False), R=cost(rng, 2, False), relative_cost=cost(rng, 4, False))
    found, expected = judged(scenario)
    loop = loop_of(scenario)
    np.testing.assert_allclose(loop, expected, rtol=1e-9, atol=1e-9)
    assert -np.linalg.eigvals(loop).real.max() == pytest.approx(found.decay_with_springs, rel=1e-6)


def test_an_own_scale_is_taken():
    scenario = on_graph(nx.path_graph(4), scale=2.5, relative_cost=30.0)
    np.testing.assert_allclose(loop_of(scenario), judged(scenario)[1], rtol=1e-9, atol=1e-9)
    assert designed(resolve(scenario)).scale == 2.5


@given(generators)
@settings(max_examples=5)
def test_where_all_hear_all_and_nothing_is_carried_it_is_the_centralized_optimum(rng):
    weights = {"Q": cost(rng, 4, False), "R": cost(rng, 2, False), "relative_cost": cost(rng, 4, False)}
    own = resolve(on_graph(nx.complete_graph(3), **weights))
    changes = {"consensus": {"kind": "centralized_lqr", **weights}}
    optimum = centralized_gains(resolve(with_overrides(on_graph(nx.complete_graph(3)), changes))).gathering
    gains = designed(own)
    found = np.kron(np.eye(3), gains.local) + np.kron(own.channels.laplacian, gains.relative)
    np.testing.assert_allclose(found, optimum, atol=1e-6 * np.abs(optimum).max())


def test_without_relative_cost_robots_do_not_mind_each_other():
    rows = block_parameters(resolve(on_graph(nx.path_graph(3), relative_cost=0.0)))["robot_2/consensus"][1]
    np.testing.assert_allclose(rows.reshape(2, 3, 4)[:, 1:], 0.0, atol=1e-9)
    np.testing.assert_allclose(rows[:, :4], [[1, 0, 9, 0], [0, 1, 0, 9]], atol=1e-9)


def test_channels_count_by_their_weight():
    def weighing(weight):
        ways = [{"speaker": i, "listener": j, "weight": weight} for i, j in ((1, 2), (2, 1))]
        return with_overrides(on_graph(nx.path_graph(2)), {"consensus.graph": ways, "consensus.scale": 1.0})

    once, half = (block_parameters(resolve(weighing(w)))["robot_1/consensus"][1] for w in (1.0, 0.5))
    local = designed(resolve(weighing(1.0))).local
    assert np.abs(once[:, 4:]).max() > 0.1
    np.testing.assert_allclose(once[:, :4] + once[:, 4:], local, atol=1e-9)
    np.testing.assert_allclose(half[:, :4] + half[:, 4:], local, atol=1e-9)


def test_a_single_robot_has_its_local_gain():
    (_, gain) = block_parameters(resolve(on_graph(nx.empty_graph(1))))["robot_1/consensus"]
    np.testing.assert_allclose(gain, [[1, 0, 9, 0], [0, 1, 0, 9]], atol=1e-9)


def test_parameters_design_it_anew():
    first, second = (on_graph(nx.path_graph(3), relative_cost=cost) for cost in (1.0, 50.0))
    diagram, rebuilt = build_diagram(first), build_diagram(second)
    context = diagram.CreateDefaultContext()
    before = diagram.GetOutputPort("robot_1_consensus_force").Eval(context)
    context.SetContinuousState(np.arange(12.0))
    set_parameters(diagram, context, second)
    fresh = rebuilt.CreateDefaultContext()
    fresh.SetContinuousState(np.arange(12.0))
    found, expected = (
        d.GetOutputPort("robot_1_consensus_force").Eval(c) for d, c in ((diagram, context), (rebuilt, fresh))
    )
    np.testing.assert_array_equal(found, expected)
    assert np.abs(found - before).max() > 1


@pytest.mark.slow
def test_engines_agree():
    start = [[2.0, 3.0], [3.0, 3.2], [2.4, 4.1]]
    scenario = with_overrides(on_graph(nx.path_graph(3), relative_cost=20.0), {**SHORT, "robots.start": start})
    blocks, compiled = (simulate(scenario, engine=name)["position"][-1] for name in ("blocks", "compiled"))
    np.testing.assert_allclose(compiled, blocks, atol=1e-6)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"robots.mass": [20.0, 40.0, 40.0]}, r"robots\.mass: masses run from 20 to 40 kg"),
        ({"consensus.Q": {"1": 2.0, "default": 1.0}}, r"consensus\.Q.*robots have different ones"),
        ({"consensus.graph": [[1, 2]]}, r"consensus\.graph: it is in parts that never hear of each other"),
        ({"consensus.graph": [[1, 2], {"speaker": 2, "listener": 3}]}, r"consensus\.graph: channels go one way"),
        ({"consensus.R": 1e-300}, r"consensus: the design leaves a mode unstable"),
        ({"consensus.scale": 0.0}, r"consensus\.scale: out of range"),
        ({"consensus.relative_cost": -1.0}, r"consensus\.relative_cost: not positive semi-definite"),
        ({"tracking": {"kind": "lqr"}}, r"tracking\.kind: 'distributed_lqr' is the whole control"),
    ],
)
def test_what_it_is_not_for_is_refused(changes, words):
    with pytest.raises(ScenarioError, match=words):
        resolve(with_overrides(on_graph(nx.path_graph(3)), changes))


def test_what_is_certified_is_another_law():
    with pytest.raises(IllPosedError, match="robot 1 coordinates by 'distributed_lqr'"):
        linearize(on_graph(nx.path_graph(3)))
