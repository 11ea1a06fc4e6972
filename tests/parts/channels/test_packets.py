"""Channels that carry packets, as they are written."""

import numpy as np
import pytest

from drake_formation import ScenarioError, load_scenario, simulate
from drake_formation.scenario import resolve, to_yaml, warnings

SHORT = {"aggregation.duration": 0.0, "transport.duration": 1.0, "consensus.delta": 20.0, "consensus.delta_v": 20.0}


def written(**channel):
    return load_scenario("line", overrides=SHORT | {"consensus.channel": {"kind": "packets"} | channel})


@pytest.mark.parametrize("engine", ["blocks", "compiled", "exponential"])
def test_an_ideal_channel_is_a_wire(engine):
    plain = load_scenario("line", overrides=SHORT)
    runs = [simulate(scenario, engine=engine)["position"] for scenario in (written(profile="ideal"), plain)]
    np.testing.assert_array_equal(*runs)


@pytest.mark.parametrize(
    ("channel", "where", "why"),
    [
        ({"profile": "ideal", "delay": 0.1}, "delay", "a wire"),
        ({"delay": 0.01, "spread": 0.02}, "spread", "before they are sent"),
        ({"spread": 0.02, "distribution": "gamma"}, "spread", "no spread"),
        ({"losses": [0.5]}, "losses", "1 or 0"),
        ({"loss": 0.6, "burst": 4, "burst_loss": 0.5}, "loss", "in a bad time"),
        ({"loss": 0.9, "burst": 2}, "burst", "shorter than one packet"),
        ({"order": "buffer"}, "playout", "missing"),
        ({"playout": 0.1}, "playout", "only a buffer"),
        ({"outages": [[2.0, 1.0]]}, "outages.0", "ends before it begins"),
        ({"repair_rate": 1.0}, "repair_rate", "nothing fails"),
        ({"delay": 100.0, "period": 0.001}, "delay", "under way at once"),
        ({"delay": -0.1}, "delay", "out of range"),
        ({"loss": 1.1}, "loss", "out of range"),
        ({"delays": "nowhere.txt"}, "delays", "cannot be read"),
        ({"delays": [0.1, -0.2]}, "delays.1", "out of range"),
    ],
)
def test_what_contradicts_itself_is_refused_with_its_place(channel, where, why):
    with pytest.raises(ScenarioError) as caught:
        written(**channel)
    assert any(f"consensus.channel.{where}" in line and why in line for line in str(caught.value).splitlines())


def test_traces_are_read_from_files_beside_the_scenario(tmp_path):
    (tmp_path / "delays.txt").write_text("# measured\n0.01\n0.03 # s\n0.02\n")
    before, rest = to_yaml(load_scenario("line")).split("consensus:")
    after = rest.split("avoidance:")[1]
    plain = f"{before}consensus:\n  channel: {{kind: packets, delays: delays.txt}}\navoidance:{after}"
    (tmp_path / "traced.yaml").write_text(plain)
    assert load_scenario(tmp_path / "traced.yaml").consensus.channel.delays == (0.01, 0.03, 0.02)
    (tmp_path / "delays.txt").write_text("0.01\n\n0.02\n")
    with pytest.raises(ScenarioError, match=r"delays\.txt: a trace has one number a line; line 2 has nothing"):
        load_scenario(tmp_path / "traced.yaml")


def test_an_outage_after_the_end_is_told():
    (warning,) = warnings(written(outages=[[5.0, 6.0]]))
    assert "after the end of the run at 1 s" in warning.message


def test_every_channel_may_have_numbers_of_its_own():
    scenario = written(delay={"1-2": 0.03, "default": 0.01})
    parts = resolve(scenario).parts["channel"]
    pairs = resolve(scenario).channels.pairs.tolist()
    assert {(j + 1, i + 1): part.network.delay for (i, j), part in zip(pairs, parts, strict=True)} == {
        (1, 2): 0.03,
        (2, 1): 0.01,
    }
