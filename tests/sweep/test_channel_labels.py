"""A map over delay and loss knows what the certificate says of each of its points."""

import numpy as np
from sweep.quick import quick_sweep

from drake_formation.sweep import load_sweep
from drake_formation.sweep.channel_labels import channel_labels

LOSS = {"path": "consensus.channel.loss", "values": [0.0, 0.9, 1.0]}
DELAY = {"path": "consensus.channel.delay", "values": [0.0, 0.12]}
STIFFNESS = {"path": "springs.stiffness", "values": [1.0, 2.0]}
BASE = {"consensus": {"delta": 1e3, "delta_v": 20.0, "channel": {"kind": "packets"}}}


def sweep(*axes):
    return load_sweep(quick_sweep(*axes, scenario="quadrilateral", set=BASE))


def test_every_point_has_the_label_of_its_scenario():
    labels = channel_labels(sweep(LOSS, DELAY))
    expected = [["stable", "unstable"], ["stable", "unstable"], ["not certified"] * 2]
    np.testing.assert_array_equal(labels, expected)
    np.testing.assert_array_equal(channel_labels(sweep(DELAY, LOSS)), np.transpose(expected))


def test_a_sweep_over_other_fields_has_none():
    assert channel_labels(sweep(LOSS, STIFFNESS)) is None
    assert channel_labels(sweep(DELAY)) is None
