"""The certificate: what it must contain, for stable loops, unstable ones and questions without an answer."""

import json

import pytest
from hypothesis import given, settings
from strategies import scenarios
from unstable import UNSTABLE

from drake_formation import load_scenario, with_overrides
from drake_formation.analysis import IllPosedError, Questions, certificate, certify, linearize, modes
from drake_formation.scenario import Scenario

NEEDS_STABILITY = {"delay_neighbour", "delay_relative", "loss", "disturbance"}


@pytest.fixture(scope="module")
def steel():
    return certify(load_scenario("line", overrides={"springs.stiffness": 3e4, "consensus.delta": 1e4}))


def test_it_has_what_is_promised_as_plain_json(steel):
    told = json.loads(steel.to_json())
    assert told["stable"] is True
    assert {mode["kind"] for mode in told["modes"]} == {"centre", "rotation", "stretch"}
    assert set(told["delay_margin_s"]) == {"neighbour", "relative"}
    assert all(0 < told["delay_margin_s"][of] < 0.01 for of in ("neighbour", "relative"))
    assert "loss_margin" in told
    assert told["not_covered"]
    assert told["units"]
    assert set(told["versions"]) >= {"drake", "drake-formation", "numpy", "python", "scipy"}
    for section in certificate.SECTIONS:
        assert section in told
        assert told[section] is not None or section in ("channels", "smallest_delta", "topology")


def test_the_scenario_in_it_repeats_it(steel):
    again = Scenario.model_validate_json(json.dumps(steel.to_dict()["scenario"]))
    assert again == steel.scenario
    assert modes(linearize(again)).slowest[0].decay_rate == steel.modes.slowest[0].decay_rate


def test_delay_margins_of_the_papers_line(steel):
    """Hardly damped virtual springs: d/(N δ) for the whole difference, d/δ for neighbours alone."""
    told = steel.to_dict()["delay_margin_s"]
    assert told["relative"] == pytest.approx(9 / 2e4, rel=0.01)
    assert told["neighbour"] == pytest.approx(9 / 1e4, rel=0.01)


def test_loss_is_judged_at_a_period_that_the_loop_tolerates(steel):
    """Sampled every 10 ms the hardly damped line is unstable even without loss; half of what it tolerates is taken."""
    told = steel.to_dict()["loss"]
    assert told["period_s"] == pytest.approx(told["longest_period_s"] / 2)
    assert told["longest_period_s"] == pytest.approx(2 * steel.sections["delay_relative"].delay_s, rel=0.01)
    assert "loss_margin" in steel.no_limit  # a loss weakens a virtual spring, and weaker ones need less damping
    at_10_ms = certify(steel.scenario, questions=Questions(period_s=0.01))
    assert "unstable even without loss" in at_10_ms.unanswered["loss"]
    assert at_10_ms.to_dict()["loss_margin"] is None
    damped = certify(with_overrides(steel.scenario, {"consensus.delta_v": 600.0})).to_dict()
    assert damped["loss"]["period_s"] == 0.01
    assert 0 < damped["loss_margin"] < 1


def test_an_unstable_loop_is_certified_as_unstable():
    found = certify(load_scenario("line", overrides=UNSTABLE))
    told = json.loads(found.to_json())
    assert told["stable"] is False
    assert [mode["kind"] for mode in told["modes"] if mode["decay_rate_1_per_s"] < 0] == ["rotation", "rotation"]
    assert set(told["unanswered"]) >= NEEDS_STABILITY
    assert told["delay_margin_s"] == {"neighbour": None, "relative": None}
    assert told["loss_margin"] is None
    assert told["no_limit"] == []
    assert told["local"][0]["stable"] is True
    assert "springs" in told["cause"]
    mended = certify(with_overrides(found.scenario, told["remedies"][0]["overrides"]))
    assert mended.stable
    assert mended.cause is None
    assert mended.remedies == ()


@pytest.mark.parametrize(
    ("channel", "stable", "label"),
    [
        ({"kind": "delay", "delay": 9.5e-4}, False, "unstable"),
        ({"kind": "delay", "delay": 8.5e-4}, True, "stable"),
        ({"kind": "packets", "quantum": 0.1}, None, "not certified"),
    ],
)
def test_a_scenario_is_as_stable_as_over_its_channels(channel, stable, label):
    """Neighbours' states may be 0.9 ms late."""
    changes = {"springs.stiffness": 3e4, "consensus.delta": 1e4, "consensus.channel": channel}
    scenario = load_scenario("line", overrides=changes)
    found = certify(scenario)
    told = json.loads(found.to_json())
    assert (found.stable, told["stable"], told["channels"]["label"]) == (stable, stable, label)
    assert found.modes.stable
    assert told["scenario"]["consensus"]["channel"]["kind"] == channel["kind"]
    assert any("wires" in line for line in told["not_covered"])


def test_one_robot_has_modes_and_no_margins():
    overrides = {"formation": {"shape": "line", "robots": 1, "side": 1.0}, "robots.start": {"centre": [0, 0]}}
    found = certify(load_scenario("line", overrides=overrides))
    assert found.stable
    assert {mode.kind for mode in found.modes.modes} == {"centre"}
    assert {"springs", "delay_neighbour", "delay_relative", "disturbance"} <= set(found.unanswered)
    assert found.to_dict()["decay_limit_1_per_s"] is None


def test_no_consensus_is_told_from_no_answer():
    """Without gains no delay matters: null because there is no limit, not because there is no answer."""
    found = certify(load_scenario("line", overrides={"consensus.delta": 0}))
    told = found.to_dict()
    assert told["delay_margin_s"] == {"neighbour": None, "relative": None}
    assert {"delay_margin_s.neighbour", "delay_margin_s.relative"} <= set(told["no_limit"])
    assert "delay_neighbour" not in told["unanswered"]


def test_robots_that_do_not_talk_are_certified_too():
    found = certify(load_scenario("quadrilateral", overrides={"consensus.graph": [[1, 2]], "consensus.delta": 0}))
    assert found.stable
    json.loads(found.to_json())


@pytest.mark.parametrize("overrides", [{"consensus.delta_v": 1e9}, {"springs.stiffness": 1e200}])
def test_what_rounding_hides_is_not_called_stable_or_unstable(overrides):
    found = certify(load_scenario("line", overrides=overrides))
    assert found.stable is None
    assert json.loads(found.to_json())["stable"] is None
    assert (found.cause, found.remedies) == (None, ())


def test_what_is_asked_is_answered():
    slow = load_scenario("line", overrides={"springs.graph": [], "tracking.Q": [1.0, 1.0, 1601.0, 1601.0]})
    found = certify(slow, questions=Questions(decay_rate=0.3, force_limit=100.0, consensus_error=1.0))
    assert found.sections["smallest_delta"].delta == pytest.approx((41 * 0.3 - 40 * 0.09 - 1) / 2, rel=1e-6)
    assert found.sections["design"].force_limited.force_limit_n == 100
    assert found.sections["topology"].graph.channels == 2


@pytest.mark.parametrize(
    "asked",
    [
        {"period_s": 0.0},
        {"period_s": float("nan")},
        {"period_s": 11.0},
        {"damping_ratio": 1.5},
        {"decay_rate": -1.0},
        {"force_limit": 0.0},
        {"consensus_error": 0.0},
    ],
)
def test_what_cannot_be_asked_is_refused(asked):
    with pytest.raises(IllPosedError, match="allowed"):
        Questions(**asked)


def test_only_ill_posed_questions_go_unanswered(monkeypatch):
    def refuses(formation, asked):
        raise IllPosedError("because")

    def fails(formation, asked):
        raise ZeroDivisionError("a fault of the program")

    scenario, called = load_scenario("line"), []
    monkeypatch.setattr(certificate, "SECTIONS", {"local": refuses})
    found = certify(scenario, progress=called.append)
    assert found.unanswered == {"local": "because"}
    assert called == ["local"]
    monkeypatch.setattr(certificate, "SECTIONS", {"local": fails})
    with pytest.raises(ZeroDivisionError):
        certify(scenario)


@pytest.mark.slow
@given(scenario=scenarios())
@settings(max_examples=10)
def test_every_scenario_gets_a_certificate(scenario):
    found = certify(scenario)
    told = json.loads(found.to_json())
    assert told["stable"] == (max(mode["eigenvalue_1_per_s"][0] for mode in told["modes"]) < 0)
    if told["stable"] and len(told["laplacian_eigenvalues"]) > 1:
        assert not NEEDS_STABILITY & set(told["unanswered"])
