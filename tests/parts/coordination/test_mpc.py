"""Model predictive control: known answers, constraints, what is said where there is no plan, and the engines."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.systems.analysis import Simulator
from pydrake.systems.controllers import DiscreteTimeLinearQuadraticRegulator
from strategies import generators

from drake_formation import ScenarioError, build_diagram, load_scenario, set_parameters, simulate
from drake_formation.analysis import IllPosedError, certify
from drake_formation.lowering.errors import LoweringError
from drake_formation.parameters import find_block
from drake_formation.parts.coordination.centralized_lqr import centralized_gains
from drake_formation.parts.coordination.linear_formation import formation_matrices, spring_matrix
from drake_formation.parts.coordination.mpc import models
from drake_formation.parts.coordination.prediction import SampledModel, prediction
from drake_formation.scenario import resolve, to_yaml, with_overrides
from drake_formation.simulation import PreparedRun, SimulationError
from drake_formation.simulation.phases import felt_obstacles

BEFORE_IT = {"avoidance.obstacles": [{"position": [5.0, 3.8], "radius": 0.3}], "avoidance.gain": 0.0}
"""An obstacle in the upper robot's way, a little below it."""
AT_ONCE = {"aggregation.duration": 0.0, "robots.start": {"centre": [2.5, 3.5]}, "transport.duration": 3.0}


def scenario(changes=None, /, **mpc):
    consensus = {"kind": "mpc", **mpc}
    return load_scenario("line", overrides={"tracking": {"kind": "none"}, "consensus": consensus, **(changes or {})})


def predicted(scenario):
    formation = resolve(scenario)
    return prediction(models(formation)[1].pack().tobytes(), formation.robots, scenario.consensus.horizon)


@given(st.integers(1, 4), generators)
@settings(max_examples=20)
def test_a_prediction_is_the_model_step_by_step(horizon, rng):
    model = SampledModel(*(rng.uniform(-1, 1, shape) for shape in ((8, 8), (8, 4), (8, 8), (4, 4), (8, 8))))
    model = SampledModel(model.a, model.b, *(m @ m.T + np.eye(len(m)) for m in list(vars(model).values())[2:]))
    foreseen = prediction(model.pack().tobytes(), 2, horizon)
    errors, plan = rng.uniform(-1, 1, 8), rng.uniform(-1, 1, (horizon, 4))
    here, cost = errors, 0.0
    for k, force in enumerate(plan):
        here = model.a @ here + model.b @ force
        np.testing.assert_allclose(foreseen.free[k] @ errors + foreseen.forced[k] @ plan.ravel(), here, atol=1e-9)
        ends = model.cost_to_go if k == horizon - 1 else model.state_cost
        cost += here @ ends @ here + force @ model.input_cost @ force
    flat = plan.ravel()
    without = sum(
        (f @ errors) @ w @ (f @ errors)
        for f, w in zip(foreseen.free, [model.state_cost] * (horizon - 1) + [model.cost_to_go], strict=True)
    )
    found = without + foreseen.slope @ errors @ flat + 0.5 * flat @ foreseen.hessian @ flat
    assert found == pytest.approx(cost, rel=1e-9)


@pytest.mark.parametrize("horizon", [1, 5, 40])
def test_where_nothing_binds_it_is_the_sampled_lqr_of_the_formation(horizon):
    free = scenario({"springs.stiffness": 50.0}, horizon=horizon, relative_cost=10.0)
    model = models(resolve(free))[1]
    gain, _ = DiscreteTimeLinearQuadraticRegulator(model.a, model.b, model.state_cost, model.input_cost)
    np.testing.assert_allclose(predicted(free).best[:4], -gain, atol=1e-8 * np.abs(gain).max())


def test_it_approaches_the_centralized_lqr_as_samples_come_faster():
    apart = []
    for period in (0.1, 0.01, 0.001):
        fast = scenario({"springs.stiffness": 50.0}, period=period, horizon=10, relative_cost=10.0)
        gain = centralized_gains(resolve(fast)).carrying
        apart.append(np.abs(predicted(fast).best[:4] + gain).max() / np.abs(gain).max())
    assert apart[0] < 0.05
    np.testing.assert_allclose(np.divide(apart[1:], apart[:-1]), 0.1, rtol=0.1)  # of first order in the period


def test_a_long_horizon_needs_no_cost_behind_it():
    """The finite problem without a cost to go forgets its end."""
    formation = resolve(scenario({"springs.stiffness": 50.0}, period=0.5, Q=100.0))
    model = models(formation)[1]
    gain, _ = DiscreteTimeLinearQuadraticRegulator(model.a, model.b, model.state_cost, model.input_cost)
    blind = SampledModel(model.a, model.b, model.state_cost, model.input_cost, model.state_cost).pack().tobytes()
    apart = [np.abs(prediction(blind, 2, horizon).best[:4] + gain).max() for horizon in (10, 40, 100)]
    assert apart[0] > 0.1
    assert apart[2] < 1e-3
    assert apart == sorted(apart, reverse=True)


def test_a_run_without_constraints_is_the_sampled_lqrs():
    """The linear springs of a formation on its way are the model's own, so it can be stepped by hand."""
    free = scenario({**AT_ONCE, "avoidance.obstacles": [], "springs.law": "linear", "simulator.accuracy": 1e-10})
    formation = resolve(free)
    result = simulate(free)
    model = models(formation)[1]
    gain, _ = DiscreteTimeLinearQuadraticRegulator(model.a, model.b, model.state_cost, model.input_cost)
    errors = np.hstack([formation.starts - formation.goal - formation.slots, np.zeros((2, 2))]).ravel()
    for _ in range(15):
        errors = (model.a - model.b @ gain) @ errors
    last = result.isel(time=-1)
    assert float(last.time) == pytest.approx(3.0)
    reached = np.hstack([last.position - formation.goal - formation.slots, last.velocity])
    np.testing.assert_allclose(reached.ravel(), errors, atol=1e-6)


def test_limits_and_clearance_are_kept():
    kept = simulate(scenario({**BEFORE_IT, **AT_ONCE, "transport.duration": 8.0}, limit=20.0, clearance=0.4))
    force = kept["consensus_force"].values
    assert np.abs(force).max() == pytest.approx(20.0)
    away = np.linalg.norm(kept["position"].values - [5.0, 3.8], axis=-1) - 0.3
    assert away.min() == pytest.approx(0.4, abs=2e-3)
    past = float(kept["position"][-1, 1, 0])
    assert past > 6.0  # around it, not before it
    ignored = simulate(scenario({**BEFORE_IT, **AT_ONCE, "transport.duration": 8.0}, limit=20.0))
    unminded = np.linalg.norm(ignored["position"].values - [5.0, 3.8], axis=-1) - 0.3
    assert unminded.min() < 0.2


def test_a_run_that_minds_obstacles_is_compared_with_one_that_meets_none():
    minding = scenario({**BEFORE_IT, **AT_ONCE}, clearance=0.4)
    assert felt_obstacles(resolve(minding))
    assert not felt_obstacles(resolve(scenario({**BEFORE_IT, **AT_ONCE})))
    short = {"transport.duration": 5.0}
    apart = simulate(with_overrides(minding, short))["deviation"].values[-1]
    unminding = simulate(with_overrides(minding, {**short, "consensus.clearance": None}))["position"].values[-1]
    np.testing.assert_allclose(
        simulate(with_overrides(minding, short))["position"].values[-1] - apart, unminding, atol=1e-6
    )
    assert np.abs(apart).max() > 0.05


def test_all_robots_make_the_same_plan():
    diagram = build_diagram(scenario({**BEFORE_IT, **AT_ONCE}, limit=20.0, clearance=0.4))
    context = diagram.CreateDefaultContext()
    Simulator(diagram, context).AdvanceTo(1.0)
    plans = [
        find_block(diagram, f"robot_{i}/consensus").GetMyContextFromRoot(context).get_discrete_state_vector()
        for i in (1, 2)
    ]
    np.testing.assert_allclose(*(plan.CopyToVector() for plan in plans), atol=1e-9)
    assert np.abs(plans[0].CopyToVector()).max() > 10


def test_obstacles_and_springs_count_from_the_hand_off_on():
    near = {"avoidance.obstacles": [{"position": [2.5, 4.5], "radius": 0.3}], "avoidance.gain": 0.0}
    gathering = scenario({**near, "springs.stiffness": 200.0, "aggregation.duration": 2.0}, clearance=0.3)
    diagram, formation = build_diagram(gathering), resolve(gathering)
    context = diagram.CreateDefaultContext()
    Simulator(diagram, context).AdvanceTo(0.05)
    gain = prediction(models(formation)[0].pack().tobytes(), 2, 20).best[:4]
    errors = np.hstack([formation.starts - formation.centre - formation.slots, np.zeros((2, 2))]).ravel()
    forces = [diagram.GetOutputPort(f"robot_{i}_consensus_force").Eval(context) for i in (1, 2)]
    np.testing.assert_allclose(np.ravel(forces), gain @ errors, rtol=1e-9)


def hurled():
    """A formation that looks so little ahead that it cannot brake before an obstacle."""
    tight = {"avoidance.obstacles": [{"position": [4.0, 3.9], "radius": 0.3}], "avoidance.gain": 0.0}
    return scenario({**tight, **AT_ONCE, "transport.duration": 8.0}, limit=20.0, clearance=0.4, horizon=2)


def test_the_upper_robot_short_of_force_is_named_and_nothing_is_lost():
    words = (
        r"stopped at t = [\d.]+ s at robot 2: no forces of at most 20 N keep it 0\.4 m from obstacle 1 over the next "
        r"0\.4 s; [\d.]+ m are missing\. Try a larger consensus\.limit or horizon, or a smaller clearance"
    )
    with pytest.raises(SimulationError, match=words) as failure:
        simulate(hurled())
    assert failure.value.robot == 2
    assert failure.value.time > 1.0
    partial = failure.value.partial
    assert float(partial["time"][-1]) == pytest.approx(failure.value.time)
    assert float(partial["position"][-1, 1, 0]) > 2.6


def test_a_run_that_stops_so_leaves_its_folder(cli, tmp_path):
    (tmp_path / "hurled.yaml").write_text(to_yaml(hurled()))
    status, _, error = cli("run", "hurled.yaml", "--out", "out")
    assert status == 3
    assert "at robot 2: no forces of at most 20 N keep it 0.4 m from obstacle 1" in error
    assert (tmp_path / "out.failed" / "result.nc").exists()


def test_it_is_not_compiled_and_says_so():
    with pytest.raises(LoweringError, match=r"robot_1/consensus.*coordination 'mpc' of drake-formation"):
        simulate(scenario(), engine="compiled")
    choice = PreparedRun(scenario({"transport.duration": 5000.0})).choice
    assert choice.engine == "blocks"
    assert "coordination 'mpc'" in choice.reason


def test_what_is_certified_is_another_law():
    with pytest.raises(IllPosedError, match="robot 1 coordinates by 'mpc'"):
        certify(scenario())


def test_parameters_plan_anew():
    first, second = scenario(limit=10.0), scenario({"springs.stiffness": 90.0}, limit=[5.0, 20.0], R=2.0, clearance=0.1)
    diagram, rebuilt = build_diagram(first), build_diagram(second)
    context, fresh = diagram.CreateDefaultContext(), rebuilt.CreateDefaultContext()
    set_parameters(diagram, context, second)
    for name in ("robot_1/consensus", "robot_2/consensus"):
        own, other = (find_block(d, name).GetMyContextFromRoot(c) for d, c in ((diagram, context), (rebuilt, fresh)))
        for k in range(6):
            np.testing.assert_array_equal(*(c.get_numeric_parameter(k).CopyToVector() for c in (own, other)))
    with pytest.raises(ValueError, match="another structure"):
        set_parameters(diagram, context, scenario(horizon=21))


def test_springs_of_the_model_are_the_objects():
    formation = resolve(scenario({"springs.stiffness": 80.0}, period=1e-4))
    a, _ = formation_matrices(formation.masses)
    found = (models(formation)[1].a - np.eye(8)) / 1e-4
    np.testing.assert_allclose(found, a + spring_matrix(formation), atol=1e-3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"consensus.graph": []}, r"consensus\.graph: robot 1 does not hear robot 2"),
        ({"tracking": {"kind": "lqr"}}, r"tracking\.kind: 'mpc' is the whole control and takes no account"),
        ({"consensus.horizon": 0}, r"consensus\.horizon: out of range"),
        ({"consensus.horizon": 101}, r"consensus\.horizon: out of range"),
        ({"consensus.period": 0.0}, r"consensus\.period: out of range"),
        ({"consensus.limit": 0.0}, r"consensus\.limit.*out of range"),
        ({"consensus.clearance": -0.1}, r"consensus\.clearance.*out of range"),
        ({"consensus.period": {"1": 0.1, "default": 0.2}}, r"consensus\.period.*robots have different ones"),
        ({"consensus.Q": 1e300, "consensus.R": 1e-300}, "Drake finds no stabilizing gain"),
    ],
)
def test_what_it_cannot_do_is_refused(changes, words):
    with pytest.raises(ScenarioError, match=words):
        resolve(with_overrides(scenario(), changes))


@pytest.mark.parametrize(
    "obstacle", [{"kind": "segment", "ends": [[9, 9], [9, 10]]}, {"position": [9, 9], "velocity": [0.1, 0.0]}]
)
def test_it_plans_around_circles_at_rest_alone_unless_it_need_not_know(obstacle):
    with pytest.raises(ScenarioError, match=r"avoidance.obstacles.0: mpc plans around circles at rest alone"):
        scenario({"consensus.clearance": 0.2, "avoidance.obstacles": [obstacle]})
    scenario({"consensus.clearance": 0.2, "avoidance.obstacles": [obstacle | {"known": False}]})
    scenario({"avoidance.obstacles": [obstacle]})


def test_what_it_does_not_know_it_keeps_no_distance_from():
    known = {**AT_ONCE, **BEFORE_IT, "transport.duration": 2.0}
    unknown = {**known, "avoidance.obstacles": [BEFORE_IT["avoidance.obstacles"][0] | {"known": False}]}
    near = {"consensus.clearance": 0.2}
    found = simulate(scenario(unknown | near))["position"].values
    free = simulate(scenario(unknown))["position"].values
    np.testing.assert_allclose(found[-1], free[-1], atol=1e-6)
