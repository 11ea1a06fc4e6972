import numpy as np
import pytest
from hypothesis import given, settings
from probe import context_at, derivatives, parameters, robot_outputs, state_of
from strategies import generators, pairs_of_scenarios, random_state, scenarios

from drake_formation.diagram import build_diagram
from drake_formation.parameters import block_parameters, find_block, set_parameters, structure
from drake_formation.scenario import ScenarioError, load_scenario, resolve, with_overrides

few = settings(max_examples=25)


@few
@given(pairs_of_scenarios(), generators)
def test_set_parameters_equals_a_rebuilt_diagram(scenarios, rng):
    """Exactly: the same parameters, and the same derivatives and outputs in any state."""
    first, second = scenarios
    diagram, rebuilt = build_diagram(first), build_diagram(second)
    state = random_state(second, rng)
    context, expected = context_at(diagram, state), context_at(rebuilt, state)
    set_parameters(diagram, context, second)
    np.testing.assert_array_equal(parameters(context), parameters(expected))
    np.testing.assert_array_equal(derivatives(diagram, context), derivatives(rebuilt, expected))
    for output in ("control_force", "spring_force", "consensus_error", "tracking_error"):
        np.testing.assert_array_equal(
            robot_outputs(diagram, context, output), robot_outputs(rebuilt, expected, output), err_msg=output
        )


QUADRILATERAL = {"avoidance.range": 5.0, "consensus.delta": 3.0, "aggregation.duration": 0.0}

CHANGES = {
    "one mass": {"robots.mass": 30.0},
    "a mass for each": {"robots.mass": [10.0, 20.0, 30.0, 40.0]},
    "stiffness": {"springs.stiffness": 3e4},
    "a stiffness for each": {"springs.stiffness": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]},
    "damping": {"springs.damping": 7.0},
    "delta": {"consensus.delta": 1e4},
    "delta_v": {"consensus.delta_v": 12.0},
    "sensing range": {"avoidance.range": 4.0},
    "avoidance gain": {"avoidance.gain": 3.0},
    "an obstacle's position": {"avoidance.obstacles.0.position": [5.0, 5.0]},
    "an obstacle's radius": {"avoidance.obstacles.0.radius": 0.3},
    "Q": {"tracking.Q": 4.0},
    "R": {"tracking.R": [1.0, 2.0]},
    "goal": {"transport.goal": [3.0, 4.0]},
    "slots": {"formation.side": 1.5},
}


@pytest.mark.parametrize("sensing", ["in_range", "nearest"])
@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_every_number_can_be_changed_and_matters(change, sensing):
    scenario = load_scenario("quadrilateral", overrides=QUADRILATERAL | {"avoidance.sensing": sensing})
    variant = with_overrides(scenario, change)
    diagram, rebuilt = build_diagram(scenario), build_diagram(variant)
    state = random_state(scenario, np.random.default_rng(0))
    context = context_at(diagram, state)
    before = derivatives(diagram, context)
    set_parameters(diagram, context, variant)
    after = derivatives(diagram, context)
    np.testing.assert_array_equal(after, derivatives(rebuilt, context_at(rebuilt, state)))
    assert (after != before).any()


def test_other_starts_move_the_aggregation_centre_and_leave_the_state_alone():
    scenario = load_scenario("line")
    variant = with_overrides(scenario, {"robots.start": [[0.0, 0.0], [2.0, 2.0]]})
    diagram = build_diagram(scenario)
    context = diagram.CreateDefaultContext()
    state = state_of(context)
    set_parameters(diagram, context, variant)
    np.testing.assert_array_equal(state_of(context), state)
    np.testing.assert_array_equal(parameters(context), parameters(build_diagram(variant).CreateDefaultContext()))


def test_time_state_and_phase_are_left_alone():
    diagram = build_diagram(load_scenario("line"))
    context = diagram.CreateDefaultContext()
    context.SetTime(61.0)
    find_block(diagram, "phase").GetMyMutableContextFromRoot(context).SetDiscreteState([1.0])
    set_parameters(diagram, context, load_scenario("line", overrides={"springs.stiffness": 5.0}))
    assert context.get_time() == 61.0
    assert diagram.GetOutputPort("phase").Eval(context) == 1.0


OTHER_STRUCTURES = {
    "more robots": {"formation": {"shape": "polygon", "robots": 5, "side": 1.0}, "robots.start": {"centre": [0, 0]}},
    "other springs": {"springs.graph": "cycle"},
    "no springs": {"springs.graph": []},
    "other channels": {"consensus.graph": "path"},
    "as many channels elsewhere": {"consensus.graph": [[1, 2], [1, 3], [1, 4], [2, 3], [2, 4]]},
    "another law": {"springs.law": "linear"},
    "another sensing": {"avoidance.sensing": "nearest"},
    "fewer obstacles": {"avoidance.obstacles": [{"position": [6.0, 5.05]}]},
    "no obstacles": {"avoidance.obstacles": []},
    "a later hand-off": {"aggregation.duration": 31.0},
    "no aggregation": {"aggregation.duration": 0.0},
}


@pytest.mark.parametrize("change", OTHER_STRUCTURES.values(), ids=OTHER_STRUCTURES)
def test_another_structure_is_refused_and_nothing_written(change):
    scenario = load_scenario("quadrilateral", overrides={"consensus.graph": [[1, 2], [1, 3], [1, 4], [2, 3], [3, 4]]})
    diagram = build_diagram(scenario)
    context = diagram.CreateDefaultContext()
    before = parameters(context)
    with pytest.raises(ValueError, match="another structure"):
        set_parameters(diagram, context, with_overrides(scenario, {**change, "robots.mass": 1.0}))
    np.testing.assert_array_equal(parameters(context), before)


def test_a_diagram_without_obstacles_takes_none():
    scenario = load_scenario("line", overrides={"avoidance.obstacles": []})
    diagram = build_diagram(scenario)
    with pytest.raises(ValueError, match="another structure"):
        set_parameters(diagram, diagram.CreateDefaultContext(), load_scenario("line"))


def test_an_unsound_scenario_is_refused_and_nothing_written():
    scenario = load_scenario("line")
    diagram = build_diagram(scenario)
    context = diagram.CreateDefaultContext()
    before = parameters(context)
    unsound = scenario.model_copy(update={"robots": scenario.robots.model_copy(update={"mass": (1.0,)})})
    with pytest.raises(ScenarioError):
        set_parameters(diagram, context, unsound)
    np.testing.assert_array_equal(parameters(context), before)


@few
@given(scenarios())
def test_the_structure_of_a_scenario_is_the_structure_of_its_diagram(scenario):
    assert structure(resolve(scenario)) == build_diagram(scenario).structure


@few
@given(scenarios())
def test_a_diagrams_blocks_hold_the_scenarios_numbers(scenario):
    diagram = build_diagram(scenario)
    context = diagram.CreateDefaultContext()
    for path, values in block_parameters(resolve(scenario)).items():
        if path == "sensing" and not diagram.HasSubsystemNamed(path):
            continue
        block = find_block(diagram, path).GetMyContextFromRoot(context)
        assert block.num_numeric_parameter_groups() == len(values)
        for index, value in enumerate(values):
            np.testing.assert_array_equal(block.get_numeric_parameter(index).CopyToVector(), np.ravel(value))
