"""The fitted number: the avoidance gain η, to the line's consensus error with rubber and without consensus."""

from dataclasses import dataclass, replace
from functools import cache

from drake_formation.measuring import metrics
from drake_formation.paper.published import published
from drake_formation.paper.readings.simulated import Settings, handed_over
from drake_formation.paper.runs import transport
from drake_formation.scenario import Scenario, with_overrides
from drake_formation.simulation import simulate

CASE = ("line", "rubber", 0.0)
BRACKET = (0.5, 45.0)
"""Where η is looked for (N m²)."""
TOLERANCE = 1e-3
"""To which η is found (N m²)."""


@dataclass(frozen=True, kw_only=True)
class Fit:
    """The fitted gain.

    Attributes:
        gain: η (N m²).
        used: what the scenarios of the reading say (N m²).
        range: ρ0 (m).
        error: the consensus error the fitted gain gives (m).
        target: the published one (m).
        runs: how many runs it took.
    """

    gain: float
    used: float
    range: float
    error: float
    target: float
    runs: int


@cache
def fit(settings: Settings | None = None) -> Fit:
    """Find η by bracketing (Brent).

    Args:
        settings: of the line; None for the runs as printed.
    """
    from scipy.optimize import root_scalar

    formation, material, delta = CASE
    target = published()[formation]["consensus_error"][material][delta] / 100
    error = cache(lambda gain: float(metrics(simulate(tried(settings, gain), engine="compiled")).consensus_error_m))
    found = root_scalar(lambda gain: error(gain) - target, bracket=BRACKET, method="brentq", xtol=TOLERANCE)
    used = (handed_over(CASE[0], settings, *CASE[1:]) if settings else transport(*CASE)).avoidance
    return Fit(
        gain=found.root,
        used=used.gain,
        range=used.range,
        error=error(found.root),
        target=target,
        runs=error.cache_info().currsize,
    )


def tried(settings: Settings | None, gain: float) -> Scenario:
    """The run at an avoidance gain (N m²)."""
    if settings is None:
        return with_overrides(transport(*CASE), {"avoidance.gain": gain})
    return handed_over(CASE[0], replace(settings, gain=gain), *CASE[1:])
