"""The paper's claims about keeping formation, by a reading of it."""

from drake_formation.measuring import Metrics
from drake_formation.paper.published import published
from drake_formation.paper.readings.score import AGREES, CLOSE, agrees
from drake_formation.paper.readings.two_readings import Reading
from drake_formation.paper.runs import FORMATIONS, GAINS, MATERIALS
from drake_formation.paper.store import Store
from drake_formation.paper.verdicts.verdict import FAILS, HOLDS, Claim, verdict
from drake_formation.scenario import resolve

KEPT = 0.01
"""A formation is kept when no robot is farther from its shape than this (m); chosen, 1 % of the side."""
LOCAL, LOW, HIGH = GAINS


def any_stiffness(reading: Reading, store: Store) -> Claim:
    """Abstract: δ > 0 keeps the formation regardless of stiffness."""
    figures = {
        (name, material): _figures(reading, store, name, material, LOW) for name in FORMATIONS for material in MATERIALS
    }
    worst = max(figures, key=lambda case: figures[case].deformation_m)
    errors = ", ".join(f"{_cm(its.consensus_error_m)} ({', '.join(case)})" for case, its in figures.items())
    turned = max(its.turned_m for its in figures.values())
    return Claim(
        claim="δ > 0 keeps the formation whatever the stiffness (Secs. 5.1.2, 5.2.2)",
        verdict=verdict(
            figures[worst].deformation_m < KEPT, max(its.consensus_error_m for its in figures.values()) < KEPT
        ),
        evidence=(
            f"at δ = {LOW:g} N/m obstacles deform the formation by at most {_cm(figures[worst].deformation_m)} "
            f"({', '.join(worst)}). The largest ‖e_i‖ are {errors}; of these the hand-off leaves up to "
            f"{_cm(max(its.residual_m for its in figures.values()))}, and up to {_cm(turned)} is the turning of the "
            "whole formation. The condition is a settled hand-off, and that turning counts as keeping"
        ),
        source=f"all transports at δ = {LOW:g}",
    )


def forces_fit_errors(reading: Reading, store: Store) -> Claim:
    """Tables 5 and 6: the published errors and forces with consensus."""
    case = ("quadrilateral", "rubber", LOW)
    figures = _figures(reading, store, *case)
    error, force = (published()[case[0]][key][case[1]][case[2]] for key in ("consensus_error", "peak_force"))
    cost = LOW * resolve(reading.transport(*case)).robots * error / 100
    free = figures.turned_m > figures.deformed_m
    met = agrees(force, figures.peak_force_n)
    return Claim(
        claim="errors and forces of Table 5 come from one run (e, u at δ > 0)",
        verdict=verdict(met, met and free),
        evidence=(
            f"published are {error:g} cm and {force:g} N; springs on displacements would ask about δ·N·e = "
            f"{cost:.0f} N for that error. Here e = {_cm(figures.consensus_error_m)}, of which turning "
            f"{_cm(figures.turned_m)} and deformation {_cm(figures.deformed_m)}, at {figures.peak_force_n:.0f} N"
        ),
        source=", ".join([*case[:2], f"δ = {LOW:g}"]),
    )


def diminishing_returns(reading: Reading, store: Store) -> Claim:
    """Sec. 5.1.2: the higher δ improves little on the lower and costs more."""
    low, mid, high = (_figures(reading, store, "line", "rubber", delta) for delta in GAINS)
    first = low.consensus_error_m - mid.consensus_error_m
    second = mid.consensus_error_m - high.consensus_error_m
    holds = abs(second) < CLOSE * first and high.peak_force_n > mid.peak_force_n > low.peak_force_n
    return Claim(
        claim="returns of δ diminish while the effort rises (Sec. 5.1.2)",
        verdict=HOLDS if holds else FAILS,
        evidence=(
            f"e falls by {_cm(first)} from δ = {LOCAL:g} to {LOW:g} and by {_cm(second, 3)} from there to "
            f"{HIGH:g}; the peak force goes {low.peak_force_n:.1f}, {mid.peak_force_n:.0f}, {high.peak_force_n:.0f} N"
        ),
        source="line, rubber",
    )


def rubber_needs_it_more(reading: Reading, store: Store) -> Claim:
    """Sec. 5.1.2: soft materials gain most."""
    saved = {
        material: _figures(reading, store, "line", material, LOCAL).consensus_error_m
        - _figures(reading, store, "line", material, LOW).consensus_error_m
        for material in MATERIALS
    }
    return Claim(
        claim="rubber needs consensus more than steel (Sec. 5.1.2)",
        verdict=HOLDS if saved["rubber"] > saved["steel"] else FAILS,
        evidence=f"δ = {LOW:g} saves "
        + " and ".join(f"{_cm(error)} of e with {material}" for material, error in saved.items()),
        source="line",
    )


def trade_off(reading: Reading, store: Store) -> Claim:
    """Sec. 5.1.2: tracking is traded for consensus."""
    cases = [(name, material) for name in ("line", "quadrilateral") for material in MATERIALS]
    paid, listed = [], []
    for name, material in cases:
        local, high = (
            _figures(reading, store, name, material, delta).stacked_tracking_error_m for delta in (LOCAL, HIGH)
        )
        paid.append(high > (1 + CLOSE) * local)
        listed.append(f"{100 * local:.1f} to {_cm(high, 1)} ({name}, {material})")
    printed = published()["line"]["tracking_error"]["rubber"]
    return Claim(
        claim="consensus is bought with tracking (Sec. 5.1.2)",
        verdict=verdict(any(paid), all(paid)),
        evidence=(
            f"from δ = {LOCAL:g} to {HIGH:g} ‖ε‖ of all robots goes from {'; '.join(listed)}. The published ‖ε₁‖ of "
            f"the line with rubber falls too, from {printed[LOCAL][0]:g} to {printed[HIGH][0]:g} cm"
        ),
        source="line and quadrilateral",
    )


def scalable(reading: Reading, store: Store) -> Claim:
    """Sec. 5.3: it works for eight robots."""
    with_it, without = (_figures(reading, store, "octagon", "rubber", delta) for delta in (LOW, LOCAL))
    agreed = with_it.disagreement_m < AGREES * without.disagreement_m
    return Claim(
        claim="the scheme scales to eight robots (Sec. 5.3)",
        verdict=HOLDS if with_it.deformation_m < KEPT and agreed else FAILS,
        evidence=(
            f"at δ = {LOW:g} obstacles deform the formation of eight by {_cm(with_it.deformation_m)} and disturb its "
            f"agreement by {_cm(with_it.disagreement_m)}; without consensus by {_cm(without.disagreement_m)}"
        ),
        source="octagon, rubber",
    )


def small_for_many(reading: Reading, store: Store) -> Claim:
    """Sec. 5.3: with many robots and a rigid object δ should be small."""
    gain, cost = {}, {}
    for material in MATERIALS:
        local, low = (_figures(reading, store, "octagon", material, delta) for delta in (LOCAL, LOW))
        gain[material] = local.disagreement_m - low.disagreement_m
        cost[material] = low.peak_force_n / local.peak_force_n
    useless = gain["steel"] < CLOSE * gain["rubber"]
    return Claim(
        claim="δ should be small for many robots and rigid objects (Sec. 5.3)",
        verdict=HOLDS if useless and cost["steel"] > 1 + CLOSE else FAILS,
        evidence=(
            f"δ = {LOW:g} takes {_cm(gain['steel'])} off what obstacles cause with steel, {_cm(gain['rubber'])} with "
            f"rubber, and multiplies the peak force by {cost['steel']:.1f} and {cost['rubber']:.1f}: with steel it "
            "costs and gives nothing"
        ),
        source="octagon",
    )


def _figures(reading: Reading, store: Store, name: str, material: str, delta: float) -> Metrics:
    return store.measured(reading.transport(name, material, delta))


def _cm(length: float, digits: int = 2) -> str:
    return f"{round(100 * length, digits) + 0.0:.{digits}f} cm"  # no -0.00
