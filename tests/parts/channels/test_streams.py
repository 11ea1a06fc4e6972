"""What becomes of packets follows from the seed alone: not from the engine, the process, or what else is random."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from drake_formation import load_scenario, simulate

SHORT = {"aggregation.duration": 0.2, "transport.duration": 0.3, "avoidance.obstacles": []}
NOISE = {"sensor": {"kind": "noisy", "position_noise": 1e-3, "velocity_noise": 1e-3, "dropout": 0.1}}
PATH = os.pathsep.join([str(Path(__file__).parents[2]), *sys.path])
ALONE = """
import sys
import numpy as np
from parts.channels.test_streams import traffic
np.save(sys.argv[1], traffic("compiled"))
"""


def traffic(engine, **changes):
    """What became of all packets, shape (time, channels, counts)."""
    return simulate(load_scenario("lossy", overrides=SHORT | changes), engine=engine)["traffic"].values


@pytest.fixture(scope="module")
def on_blocks():
    return traffic("blocks")


def test_on_every_engine(on_blocks):
    assert on_blocks[-1].sum() > 0
    np.testing.assert_array_equal(traffic("compiled"), on_blocks)


@pytest.mark.slow
def test_in_another_process(on_blocks, tmp_path):
    file = tmp_path / "traffic.npy"
    subprocess.run([sys.executable, "-c", ALONE, str(file)], check=True, env=os.environ | {"PYTHONPATH": PATH})
    np.testing.assert_array_equal(np.load(file), on_blocks)


@pytest.mark.slow
def test_with_other_random_parts(on_blocks):
    np.testing.assert_array_equal(traffic("compiled", **NOISE)[-1], on_blocks[-1])


def test_another_seed_loses_others(on_blocks):
    assert not np.array_equal(traffic("compiled", seed=1)[-1], on_blocks[-1])
