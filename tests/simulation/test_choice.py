import pytest

from drake_formation import ScenarioError, load_scenario, simulate, with_overrides
from drake_formation.lowering import LoweringError
from drake_formation.scenario import shipped_scenarios
from drake_formation.simulation import PreparedRun, engines
from drake_formation.simulation.choice import COMPILE_SECONDS, blocks_seconds, choose, steps

STIFF = {"springs.stiffness": 3e4, "consensus.delta": 2e4}
SHORT = {"aggregation.duration": 1.0, "transport.duration": 2.0}


@pytest.mark.parametrize("name", shipped_scenarios())
def test_a_short_run_is_left_to_the_blocks_and_a_stiff_one_compiled(name):
    assert choose(load_scenario(name, overrides=SHORT)).engine == "blocks"
    assert choose(load_scenario(name, overrides=STIFF)).engine == "compiled"


def test_the_engine_is_named_with_the_reason_in_the_result():
    scenario = load_scenario("line", overrides=SHORT)
    result = simulate(scenario)
    assert result.attrs["engine"] == "blocks"
    assert result.attrs["engine_reason"] == choose(scenario).reason
    assert "engine_reason" not in simulate(scenario, engine="blocks").attrs
    assert simulate(scenario, engine="compiled").attrs["engine"] == "compiled"


def test_a_long_run_is_compiled_and_is_the_compiled_engines_to_the_last_bit():
    scenario = load_scenario("octagon", overrides=STIFF | {"aggregation.duration": 1.0, "transport.duration": 5.0})
    assert blocks_seconds(scenario) > COMPILE_SECONDS
    result = simulate(scenario)
    assert result.attrs["engine"] == "compiled"
    assert result.equals(simulate(scenario, engine="compiled"))


@pytest.mark.parametrize(
    ("override", "word"),
    [
        ({"simulator.integration_scheme": "runge_kutta3"}, "integration_scheme"),
        ({"simulator.target_realtime_rate": 1.0}, "target_realtime_rate"),
    ],
)
def test_what_the_compiled_engine_does_not_have_is_left_to_the_blocks_with_the_reason(override, word):
    scenario = load_scenario("octagon", overrides=STIFF | override)
    choice = choose(scenario)
    assert choice.engine == "blocks"
    assert word in choice.reason
    with pytest.raises(ScenarioError, match=word):
        simulate(with_overrides(scenario, SHORT), engine="compiled")


def test_a_diagram_that_cannot_be_compiled_is_left_to_the_blocks_with_the_reason(monkeypatch):
    def refuse(_diagram):
        raise LoweringError("robot_1/plant", "it is too heavy")

    monkeypatch.setitem(engines.ENGINES, "compiled", refuse)
    choice = PreparedRun(load_scenario("octagon", overrides=STIFF)).choice
    assert choice.engine == "blocks"
    assert "too heavy" in choice.reason


@pytest.mark.parametrize(
    "overrides",
    [
        {},
        {"springs.stiffness": 3e4},
        {"springs.stiffness": 3e4, "consensus.delta_v": 1e4},
        {"simulator.accuracy": 1e-9},
    ],
)
def test_steps_are_estimated_within_a_factor_of_four(overrides):
    scenario = load_scenario("quadrilateral", overrides={"aggregation.duration": 10.0} | overrides)
    result = simulate(scenario, engine="compiled")
    taken = int((result["phase"] == 1).sum())
    assert 0.25 < steps(scenario, scenario.transport.duration, carrying=True) / taken < 4


def test_fixed_steps_are_counted():
    overrides = {"simulator.use_error_control": False, "simulator.max_step_size": 1e-3}
    assert steps(load_scenario("line", overrides=overrides), 7.0, carrying=True) == pytest.approx(7000)
