"""Known answers of delay and sampling: the channels' own blocks in Drake's Simulator meet them within 1 %."""

from types import SimpleNamespace

import networkx as nx
import numpy as np
import pytest
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import Demultiplexer, LinearSystem, LogVectorOutput, Multiplexer
from scipy.optimize import brentq

from drake_formation.analysis import PacketChannel, packet_verdict
from drake_formation.parts.channels.delay_line import DelayLine
from drake_formation.parts.channels.packet_law import CARRY, LOST
from drake_formation.parts.channels.packets import Packets

TWO_STATES = np.diag([-2.0, -0.9]), np.array([[-1.0, 0.0], [-1.0, -1.0]])
OSCILLATOR = np.array([[0.0, 1.0], [-2.0, 0.1]]), np.array([[0.0, 0.0], [1.0, 0.0]])
SERVO = np.array([[0.0, 1.0], [0.0, -0.1]]), -np.array([[0.0], [0.1]]) @ np.array([[3.75, 11.5]])
COMPLETE = nx.laplacian_matrix(nx.complete_graph(4)).toarray().astype(float)
CONSENSUS = -np.ones((4, 4)) / 4, -COMPLETE
"""ẋ = A x + A_d h, where h is x as a channel brings it."""


def growth(system, channel, seconds):
    """Rate at which the state grows (1/s), where every two of its numbers and their rates go through a channel."""
    present, heard = system
    size = len(present)
    pairs = size // 2
    builder = DiagramBuilder()
    into = np.hstack([np.hstack([heard[:, 2 * k : 2 * k + 2], np.zeros((size, 2))]) for k in range(pairs)])
    rows = [matrix[2 * k : 2 * k + 2] for k in range(pairs) for matrix in (np.eye(size), present)]
    through = [matrix[2 * k : 2 * k + 2] for k in range(pairs) for matrix in (np.zeros_like(into), into)]
    plant = builder.AddSystem(LinearSystem(present, into, np.vstack(rows), np.vstack(through)))
    split, join = builder.AddSystem(Demultiplexer(4 * pairs, 4)), builder.AddSystem(Multiplexer([4] * pairs))
    builder.Connect(plant.get_output_port(), split.get_input_port())
    builder.Connect(join.get_output_port(), plant.get_input_port())
    start = np.linspace(1.0, -0.5, size)
    for k in range(pairs):
        block = builder.AddSystem(channel(np.concatenate([start[2 * k : 2 * k + 2], [0.0, 0.0]])))
        builder.Connect(split.get_output_port(k), block.GetInputPort("sent"))
        builder.Connect(block.GetOutputPort("received"), join.get_input_port(k))
    log = LogVectorOutput(plant.get_output_port(), builder, seconds / 1000)
    simulator = Simulator(builder.Build())
    simulator.get_mutable_integrator().set_target_accuracy(1e-6)
    simulator.get_mutable_context().SetContinuousState(start)
    simulator.AdvanceTo(seconds)
    size = np.abs(log.FindLog(simulator.get_context()).data()).max(axis=0)
    return np.log(size[800:].max() / size[400:600].max()) / (0.4 * seconds)


def delay(seconds, pieces=4):
    """A pure delay, before which nothing moved."""
    return lambda start: DelayLine(seconds / pieces, 0.0, np.tile(start, pieces + 1), 0.0)


def packets(**settings):
    """Packets, of which the first is known."""
    part = Packets(Packets.Config(**settings))

    def channel(start):
        return part.block(alone(start), 0, part.numbers(alone(start), 0))

    return channel


def alone(start):
    """As much of a formation as a channel between two asks for."""
    return SimpleNamespace(
        has_medium=False,
        channels=SimpleNamespace(pairs=np.array([[0, 1]])),
        slots=np.zeros((2, 2)),
        start_state=lambda robot: np.array([*start[:2], 0.0, 0.0]) if robot else np.zeros(4),
        begin=0.0,
        seed=0,
    )


@pytest.mark.parametrize(
    ("system", "end", "stable_below", "seconds"),
    [
        (TWO_STATES, 6.172581, True, 400.0),
        (OSCILLATOR, 0.100168, False, 100.0),
        (OSCILLATOR, 1.717858, True, 100.0),
        (SERVO, 1.167144, True, 100.0),
        (CONSENSUS, 0.392699, True, 20.0),
    ],
)
def test_a_pure_delay(system, end, stable_below, seconds):
    below, above = (growth(system, delay(share * end), seconds) for share in (0.99, 1.01))
    assert (below < 0, above < 0) == (stable_below, not stable_below)


def test_packets_once_a_period():
    """The sampling limit of held state feedback."""
    below, above = (growth(SERVO, packets(period=share * 1.729414), 200.0) for share in (0.99, 1.01))
    assert below < 0 < above


def test_packets_that_are_late():
    """Ten periods late: the period at which the verdict on the ticks turns."""

    def rate(period):
        channel = PacketChannel(SERVO[1], np.eye(2), period, 10 * period)
        return packet_verdict(SERVO[0], [channel]).growth_1_per_s

    end = brentq(rate, 0.05, 0.15)
    below, above = (growth(SERVO, packets(period=s, delay=10 * s), 100.0) for s in (0.99 * end, 1.01 * end))
    assert below < 0 < above
    assert above == pytest.approx(rate(1.01 * end), rel=0.1)


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_lost_packets(share):
    """x(k+1) = 1.25 x(k) − 1.25 γ x(k) keeps its mean square where 1 − p is 1 − 1/1.25² = 0.36: over three packets."""
    part, start, count = Packets(Packets.Config(period=1.0, loss=share * 0.64)), alone(np.zeros(4)), 150_000
    numbers, state = np.concatenate(part.numbers(start, 0)), np.concatenate(part.initial_discrete_state(start, 0))
    lost = np.zeros(count + 1)
    for k in range(count):
        CARRY(float(k), np.zeros(4), state, numbers)
        lost[k + 1] = state[LOST]
    arrived = 1 - np.diff(lost).reshape(-1, 3)
    square = np.prod((1.25 - 1.25 * arrived) ** 2, axis=1).mean()
    assert (square < 1) == (share < 1)
    assert square == pytest.approx(share**3, rel=0.02)
