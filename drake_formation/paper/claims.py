"""The paper's claims, each with a verdict, the number that decides it and the run it came from."""

from collections.abc import Callable

import numpy as np

from drake_formation.measuring import metrics
from drake_formation.paper import theorems
from drake_formation.paper.curves import phase, whole_error
from drake_formation.paper.runs import (
    AGGREGATION_GAINS,
    FORMATIONS,
    GAINS,
    MATERIALS,
    TOPOLOGIES,
    aggregation,
    topology,
    transport,
)
from drake_formation.paper.store import Store
from drake_formation.paper.verdicts import FAILS, HOLDS, Claim, verdict
from drake_formation.scenario import Scenario
from drake_formation.vectors import length

KEPT = 0.01
"""A formation is kept when no robot is farther from agreement than this (m); chosen, 1 % of the side."""


def finals(store: Store) -> Claim:
    """Sec. 5.1.1: where the robots end up."""
    gathered = phase(store[aggregation("line", 0.0)], 0).isel(time=-1)
    error = float(np.abs(gathered["position"].values - [[2.5, 3.0], [2.5, 4.0]]).max())
    return Claim(
        claim="aggregation ends at (2.5, 3) and (2.5, 4) (Sec. 5.1.1)",
        verdict=HOLDS if error < 5e-3 else FAILS,
        evidence=f"within {1000 * error:.1f} mm after {float(gathered['time']):.0f} s",
        source="line, δ = 0, aggregation",
    )


def faster_aggregation(store: Store) -> Claim:
    """Sec. 5.1.1: higher δ aggregates faster."""
    reach, settle = [], []
    for delta in AGGREGATION_GAINS:
        gathering = phase(store[aggregation("line", delta)], 0)
        error = whole_error(gathering).values
        time = gathering["time"].values
        reach.append(float(time[np.argmax(error < 0.05 * error[0])]))
        settle.append(float(time[np.flatnonzero(error > 0.02 * error[0])[-1]]))
    first = ", ".join(f"{t:.1f}" for t in reach)
    last = ", ".join(f"{t:.0f}" for t in settle)
    return Claim(
        claim="higher δ aggregates faster (Sec. 5.1.1)",
        verdict=verdict(sorted(reach, reverse=True) == reach, sorted(settle, reverse=True) == settle),
        evidence=(
            f"the error first falls below 5 % after {first} s for δ = 0, 1, 5 N/m, but stays below 2 % only after "
            f"{last} s: with δ_v = 0 the relative mode m s² + 9 s + 1 + Nδ = 0 always decays at 9/(2m) = 0.1125 1/s. "
            "It holds for the first arrival; for settling it needs δ_v > 0"
        ),
        source="line, aggregation",
    )


def any_stiffness(store: Store) -> Claim:
    """Abstract: δ > 0 keeps the formation regardless of stiffness."""
    errors = {
        (name, material): metrics(store[transport(name, material, 1e4)]).consensus_error_m
        for name in FORMATIONS
        for material in MATERIALS
    }
    caused = {key: _disagreement_from_obstacles(store, *key) for key in errors}
    worst = max(caused, key=lambda key: caused[key])
    listed = ", ".join(f"{100 * e:.2f} cm ({name}, {material})" for (name, material), e in errors.items())
    return Claim(
        claim="δ > 0 keeps the formation whatever the stiffness (Secs. 5.1.2, 5.2.2)",
        verdict=verdict(caused[worst] < KEPT, max(errors.values()) < KEPT),
        evidence=(
            f"at δ = 1e4 the obstacles disturb the agreement by at most {100 * caused[worst]:.2f} cm ({worst[0]}, "
            f"{worst[1]}); "
            "the condition is a settled hand-off, since the largest error of the whole transport is the residual "
            f"there: {listed}"
        ),
        source="all transports at δ = 1e4",
    )


def _disagreement_from_obstacles(store: Store, formation: str, material: str) -> float:
    """Largest consensus error of the deviation from the obstacle-free response (m)."""
    deviation = phase(store[transport(formation, material, 1e4)], 1)["deviation"]
    return float(length(deviation - deviation.mean("robot")).max())


def diminishing_returns(store: Store) -> Claim:
    """Sec. 5.1.2: δ = 2e4 improves little on 1e4 and costs more."""
    low, mid, high = (metrics(store[transport("line", "rubber", delta)]) for delta in GAINS)
    first = low.consensus_error_m - mid.consensus_error_m
    second = mid.consensus_error_m - high.consensus_error_m
    holds = abs(second) < 0.1 * first and high.peak_force_n > mid.peak_force_n > low.peak_force_n
    return Claim(
        claim="returns of δ diminish while the effort rises (Sec. 5.1.2)",
        verdict=HOLDS if holds else FAILS,
        evidence=(
            f"e falls by {100 * first:.2f} cm from δ = 0 to 1e4 and by {100 * second:.3f} cm from there to 2e4; the "
            f"peak force goes {low.peak_force_n:.1f}, {mid.peak_force_n:.0f}, {high.peak_force_n:.0f} N"
        ),
        source="line, rubber",
    )


def rubber_needs_it_more(store: Store) -> Claim:
    """Sec. 5.1.2: soft materials gain most."""
    saved = {
        material: metrics(store[transport("line", material, 0.0)]).consensus_error_m
        - metrics(store[transport("line", material, 1e4)]).consensus_error_m
        for material in MATERIALS
    }
    return Claim(
        claim="rubber needs consensus more than steel (Sec. 5.1.2)",
        verdict=HOLDS if saved["rubber"] > saved["steel"] else FAILS,
        evidence=(
            f"δ = 1e4 saves {100 * saved['rubber']:.2f} cm of e with rubber and {100 * saved['steel']:.2f} cm with "
            "steel"
        ),
        source="line",
    )


def scalable(store: Store) -> Claim:
    """Sec. 5.3: it works for eight robots."""
    error = _disagreement_from_obstacles(store, "octagon", "rubber")
    local = metrics(store[transport("octagon", "rubber", 0.0)]).consensus_error_m
    return Claim(
        claim="the scheme scales to eight robots (Sec. 5.3)",
        verdict=HOLDS if error < 0.2 * local else FAILS,
        evidence=(
            f"at δ = 1e4 the obstacles disturb the agreement of eight robots by {100 * error:.2f} cm; without "
            f"consensus e reaches {100 * local:.1f} cm"
        ),
        source="octagon, rubber",
    )


def topologies_beat_local(store: Store) -> Claim:
    """Sec. 5.4: every connected topology beats local LQR."""
    local = metrics(store[transport("quadrilateral", "rubber", 0.0)]).consensus_error_m
    errors = {name: metrics(store[topology(name)]).consensus_error_m for name in TOPOLOGIES}
    return Claim(
        claim="every connected topology beats local LQR (Sec. 5.4)",
        verdict=HOLDS if max(errors.values()) < local else FAILS,
        evidence=f"{100 * local:.2f} cm without; " + ", ".join(f"{100 * e:.2f} cm, {n}" for n, e in errors.items()),
        source="quadrilateral, rubber, δ = 2e4",
    )


def ten_as_twelve(store: Store) -> Claim:
    """Sec. 5.4: ten channels perform as twelve."""
    twelve, ten = (metrics(store[topology(name)]).consensus_error_m for name in list(TOPOLOGIES)[:2])
    same = abs(ten - twelve) < 0.1 * twelve
    return Claim(
        claim="ten channels perform as twelve (Sec. 5.4)",
        verdict=HOLDS if same else FAILS,
        evidence=f"largest e {100 * ten:.2f} against {100 * twelve:.2f} cm; both are the residual at the hand-off",
        source="quadrilateral, rubber, δ = 2e4",
    )


CLAIMS: tuple[Callable[[Store], Claim], ...] = (
    theorems.gain,
    finals,
    faster_aggregation,
    any_stiffness,
    diminishing_returns,
    rubber_needs_it_more,
    scalable,
    topologies_beat_local,
    ten_as_twelve,
    theorems.theorem_1,
    theorems.theorem_2,
    theorems.lemmas,
    theorems.lemma_2,
)
"""Every claim, in the order of the report."""


def claim_runs() -> list[Scenario]:
    """The runs the claims need."""
    return [
        *(aggregation("line", delta) for delta in AGGREGATION_GAINS),
        *(transport("line", material, delta) for material in MATERIALS for delta in GAINS),
        *(transport(name, material, 1e4) for name in FORMATIONS for material in MATERIALS),
        transport("octagon", "rubber", 0.0),
        transport("quadrilateral", "rubber", 0.0),
        *(topology(name) for name in TOPOLOGIES),
    ]
