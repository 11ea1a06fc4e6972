"""Channels that share a medium, in a diagram: on both engines, and what is said of it."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from drake_formation import ScenarioError, build_diagram, load_scenario
from drake_formation.lowering import lower
from drake_formation.scenario.resolve import resolve, warnings

SLOW = {
    "tdma": {"kind": "tdma", "bit_rate": 1e5, "guard": 1e-4},
    "aloha": {"kind": "aloha", "bit_rate": 5e5, "range": 1.2},
    "csma": {"kind": "csma", "bit_rate": 2e5, "power": -40.0},
    "priority": {"kind": "priority", "bit_rate": 1e5},
    "broadcast": {"kind": "tdma", "bit_rate": 5e4, "broadcast": True, "power": -40.0},
}


def scenario(medium, channel=None, **more):
    channel = {"kind": "packets", "period": 0.02, **(channel or {})}
    overrides = {"transport.duration": 2.0, "consensus.channel": channel, "consensus.medium": medium, **more}
    return load_scenario("shared-medium", overrides=overrides)


def traffic_ports(diagram):
    names = [diagram.get_output_port(k).get_name() for k in range(diagram.num_output_ports())]
    return ["medium_airtime", *(name for name in names if name.endswith("_traffic"))]


def compiled(diagram, names, end):
    lowered = lower(diagram)
    context = diagram.CreateDefaultContext()
    *_, piece = lowered.integrate(context, end, at=np.array([end]), record=names)
    return lowered.named(names, piece.recorded)


@pytest.mark.slow
@pytest.mark.parametrize("medium", SLOW)
def test_both_engines_carry_the_same_packets_and_none_is_forgotten(medium):
    diagram = build_diagram(scenario(SLOW[medium], {"delay": 0.03, "spread": 0.03, "loss": 0.1}))
    names = traffic_ports(diagram)
    found = compiled(diagram, names, 0.995)
    simulator = Simulator(diagram)
    simulator.AdvanceTo(0.995)
    airtime, *traffic = [diagram.GetOutputPort(name).Eval(simulator.get_context()) for name in names]
    for name, values in zip(names, (airtime, *traffic), strict=True):
        np.testing.assert_array_equal(found[name][-1], values)
    sent, lost, delivered = np.sum(traffic, axis=0)[:3]
    assert len(traffic) == 12
    assert sent == 12 * 50
    assert 0 <= sent - lost - delivered <= 12 * 5  # on their way or waiting
    assert 0 < airtime[1] <= 12 * 50
    assert delivered <= airtime[1]


def test_over_a_fast_medium_packets_are_there_at_the_next_look():
    diagram = build_diagram(scenario({"kind": "tdma", "bit_rate": 1e6}))
    names = traffic_ports(diagram)
    for values in list(compiled(diagram, names, 1.01).values())[1:]:
        assert (values[-1, 0], values[-1, 1], values[-1, 2]) == (51, 0, 50)
        assert values[-1, 5] == pytest.approx(0.98)


def test_a_packet_that_is_carried_between_two_looks_is_taken_at_the_later_one():
    given = {"kind": "priority", "bit_rate": 256 / 0.0012}
    diagram = build_diagram(scenario(given, {"looks": 4}))
    names = traffic_ports(diagram)
    through = {"channel_2_to_1_traffic": 1.2e-3, "channel_1_to_2_traffic": 4.8e-3, "channel_3_to_2_traffic": 6.0e-3}
    for look in (1.0, 1.005, 1.010):
        found = compiled(diagram, names, look + 1e-4)
        for name, later in through.items():
            assert found[name][-1, 5] == pytest.approx(1.0 if 1.0 + later <= look else 0.98)


def test_without_a_medium_there_is_none():
    diagram = build_diagram(scenario({"kind": "none"}))
    assert not diagram.HasSubsystemNamed("medium")
    assert not resolve(load_scenario("line")).has_medium


def test_a_medium_too_slow_for_its_traffic_is_said_with_its_utilisation():
    (slow,) = warnings(scenario({"kind": "priority", "bit_rate": 1e5}))
    assert slow.message == "the channels ask for 1.54 of the airtime there is"
    assert slow.path == ("consensus", "medium", "bit_rate")
    (aloha,) = warnings(scenario({"kind": "aloha", "bit_rate": 2e5}))
    assert aloha.message.endswith("ask for 0.768 of the airtime there is, of which slotted ALOHA carries 0.37 at most")
    assert not warnings(scenario({"kind": "aloha", "bit_rate": 4.2e5}))
    assert not warnings(scenario({"kind": "csma", "bit_rate": 1e5, "broadcast": True}))
    assert not warnings(load_scenario("shared-medium"))


@pytest.mark.parametrize(
    ("medium", "channel", "message"),
    [
        ({"kind": "tdma", "bit_rate": 1e5}, {"kind": "ideal"}, "shared by channels that carry packets"),
        ({"kind": "tdma", "bit_rate": 1e5, "noise": -80.0}, {}, "of no effect without a power"),
        ({"kind": "csma", "bit_rate": 1e8}, {}, "a frame would be over before another robot hears it"),
        ({"kind": "tdma", "bit_rate": 0.0}, {}, "bit_rate"),
        ({"kind": "tdma"}, {}, "bit_rate"),
        ({"kind": "tdma", "bit_rate": 1e5}, {"phase": {"2-1": 0.01, "default": 0.0}}, "at the same times"),
        ({"kind": "tdma", "bit_rate": 1e5, "broadcast": True}, {"bits": {"2-1": 64.0, "default": 256.0}}, "at once"),
    ],
)
def test_what_contradicts_itself_is_refused(medium, channel, message):
    channel = {"kind": "packets", **channel} if channel.get("kind") != "ideal" else channel
    with pytest.raises(ScenarioError, match=message):
        load_scenario("shared-medium", overrides={"consensus.channel": channel, "consensus.medium": medium})


@pytest.mark.slow
def test_channels_that_nobody_listens_to_offer_nothing():
    channel, medium = {"kind": "packets", "period": 0.02}, SLOW["tdma"]
    alone = {"kind": "none", "channel": channel, "medium": medium}
    diagram = build_diagram(load_scenario("shared-medium", overrides={"consensus": alone}))
    assert compiled(diagram, ["medium_airtime"], 0.5)["medium_airtime"][-1].tolist() == [0.0] * 5
