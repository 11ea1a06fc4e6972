"""The line's experiments as shipped, against what an independent solver gets with these settings."""

import pytest

from drake_formation import load_scenario, metrics, simulate

# stiffness (N/m), delta (N/m); tracking error (cm), consensus error (cm), peak force (N), each as printed
ROWS = {
    "rubber, local": (1.45, 0.0, "18.7", "9.61", "22.5"),
    "rubber, delta 1e4": (1.45, 1e4, "15.3", "0.287", "73"),
    "rubber, delta 2e4": (1.45, 2e4, "15.3", "0.290", "131"),
    "steel, local": (3e4, 0.0, "15.5", "0.51", "22.5"),
}


def printed(text):
    """A printed number, within 1 % and the rounding of its last digit."""
    decimals = len(text.partition(".")[2])
    return pytest.approx(float(text), rel=0, abs=0.01 * float(text) + 0.5 * 10**-decimals)


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_the_line_reproduces_the_table(row):
    stiffness, delta, tracking, consensus, force = row
    scenario = load_scenario("line", overrides={"springs.stiffness": stiffness, "consensus.delta": delta})
    measured = metrics(simulate(scenario))
    assert {
        "tracking error (cm)": 100 * max(measured.tracking_error_m),
        "consensus error (cm)": 100 * measured.consensus_error_m,
        "peak force (N)": measured.peak_force_n,
    } == {
        "tracking error (cm)": printed(tracking),
        "consensus error (cm)": printed(consensus),
        "peak force (N)": printed(force),
    }
