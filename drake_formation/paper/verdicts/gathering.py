"""The paper's claims about aggregation (Sec. 5.1.1), which are the same by every reading."""

import numpy as np

from drake_formation.paper.figures.curves import farthest, phase
from drake_formation.paper.published import published
from drake_formation.paper.runs import AGGREGATION_GAINS, aggregation
from drake_formation.paper.store import Store
from drake_formation.paper.verdicts.verdict import FAILS, HOLDS, Claim, verdict
from drake_formation.scenario import resolve

FIRST, LAST = 0.05, 0.02
"""Shares of the initial error: below the one for the first time, and below the other from then on."""


def finals(store: Store) -> Claim:
    """Sec. 5.1.1: where the robots end up."""
    wanted = published()["line"]["aggregated_m"]
    gathered = phase(store[aggregation("line", 0.0)], 0).isel(time=-1)
    error = float(np.abs(gathered["position"].values - wanted).max())
    places = " and ".join(f"({x:g}, {y:g})" for x, y in wanted)
    return Claim(
        claim=f"aggregation ends at {places} (Sec. 5.1.1)",
        verdict=HOLDS if error < 5e-3 else FAILS,
        evidence=f"within {1000 * error:.1f} mm after {float(gathered['time']):.0f} s",
        source="line, δ = 0, aggregation",
    )


def faster_aggregation(store: Store) -> Claim:
    """Sec. 5.1.1: higher δ aggregates faster."""
    reach, settle = [], []
    for delta in AGGREGATION_GAINS:
        gathering = phase(store[aggregation("line", delta)], 0)
        error = farthest(gathering).values
        time = gathering["time"].values
        reach.append(float(time[np.argmax(error < FIRST * error[0])]))
        settle.append(float(time[np.flatnonzero(error > LAST * error[0])[-1]]))
    part = resolve(aggregation("line", 0.0)).parts
    mass, (_, damping) = part["robot"][0].config.mass, _tracking_gains()
    gains = ", ".join(f"{delta:g}" for delta in AGGREGATION_GAINS)
    return Claim(
        claim="higher δ aggregates faster (Sec. 5.1.1)",
        verdict=verdict(sorted(reach, reverse=True) == reach, sorted(settle, reverse=True) == settle),
        evidence=(
            f"the error first falls below {100 * FIRST:g} % after {', '.join(f'{t:.1f}' for t in reach)} s for "
            f"δ = {gains} N/m, but stays below {100 * LAST:g} % only after {', '.join(f'{t:.0f}' for t in settle)} s: "
            f"with δ_v = 0 the relative mode m s² + {damping:g} s + 1 + Nδ = 0 always decays at {damping:g}/(2m) = "
            f"{damping / (2 * mass):.4f} 1/s. It holds for the first arrival; for settling it needs δ_v > 0"
        ),
        source="line, aggregation",
    )


def _tracking_gains() -> tuple[float, float]:
    """Position and velocity gain of the published K_l."""
    row = published()["lqr"]["K_l"][0]
    return row[0], row[2]
