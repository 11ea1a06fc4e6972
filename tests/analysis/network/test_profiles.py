"""No simulation contradicts what the channel certificate says of a shipped scenario over a named profile."""

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.analysis import channel_certificate, linearize, modes
from drake_formation.parts.channels.profiles import PROFILES

AT_REST = {
    "aggregation.duration": 0.0,
    "avoidance.obstacles": [],
    "transport.reference": {"kind": "set_point"},
    "transport.goal": [0.0, 0.0],
}
GAINS = {
    "as shipped": {},
    "published": {"consensus.delta": 1e4},
    "damped": {"consensus.delta": 100.0, "consensus.delta_v": 60.0},
}
UNKNOWN_FOR = 2.0
"""How long to watch where nothing is known of how fast deviations grow (s)."""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["line", "quadrilateral", "octagon"])
def test_no_run_contradicts_the_label(name):
    rows = [row(name, gains, profile) for gains in GAINS for profile in PROFILES]
    table = "\n".join(f"{gains:12}{profile:12}{label:16}{grown:.3g}" for gains, profile, label, grown in rows)
    assert not [row for row in rows if contradicted(*row[2:])], f"\n{table}"
    assert {row[2] for row in rows} == {"stable", "unstable", "not certified"}, f"\n{table}"


def contradicted(label, grown):
    return (label == "stable" and not grown < 1) or (label == "unstable" and not grown > 1)


def row(name, gains, profile):
    """Gains, profile, label, and by how much a small deviation has grown meanwhile."""
    channel = {"consensus.channel": {"kind": "packets", "profile": profile}}
    formation = linearize(load_scenario(name, overrides=AT_REST | GAINS[gains] | channel))
    verdict = channel_certificate(formation)
    if verdict is None:
        over_wires = modes(formation)
        label, rate = "stable" if over_wires.stable else "unstable", -over_wires.slowest[0].decay_rate
    else:
        label, rate = verdict.label, verdict.growth_1_per_s
    duration = UNKNOWN_FOR if rate is None else 3 / abs(rate)
    slots = formation.resolved.slots
    off = 1e-4 * np.random.default_rng(1).normal(size=slots.shape)
    given = AT_REST | GAINS[gains] | channel
    given |= {"robots.start": (slots + off).tolist(), "transport.duration": duration}
    run = simulate(load_scenario(name, overrides=given), engine="compiled")
    size = np.linalg.norm((run["position"] - run["slot"]).values, axis=(1, 2))
    early, late = (size[int(share * len(size)) :][: len(size) // 5].max() for share in (0.2, 0.8))
    return gains, profile, label, float(late / early)
