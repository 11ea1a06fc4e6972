"""The ticks of channels: when what is late is there, and when all send together again."""

import numpy as np
import pytest

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.packet_schedule import PacketChannel, schedule


def test_late_packets_wait_for_the_next_look():
    matrix = np.eye(1)
    for looks, delay, expected in (
        (1, 0.0, 0),
        (1, 0.001, 1),
        (1, 0.01, 1),
        (1, 0.0101, 2),
        (2, 0.0101, 3),
        (2, 0.005, 1),
    ):
        times = schedule([PacketChannel(matrix, matrix, 0.01, delay, looks)])
        assert times.late == (expected,)
        assert times.tick == pytest.approx(0.01 / looks)


def test_channels_of_other_periods_and_phases_share_a_tick():
    matrix = np.eye(1)
    times = schedule([PacketChannel(matrix, matrix, 0.02), PacketChannel(matrix, matrix, 0.03, phase=0.005)])
    assert (times.tick, times.ticks, times.every, times.first) == (pytest.approx(0.005), 12, (4, 6), (0, 1))
    with pytest.raises(IllPosedError, match=r"every 0\.01, 0\.0101 s have no common tick"):
        schedule([PacketChannel(matrix, matrix, 0.01), PacketChannel(matrix, matrix, 0.0101)])
