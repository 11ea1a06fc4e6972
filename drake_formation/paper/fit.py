"""The one fitted number: the avoidance gain η, to the line's consensus error of 9.6 cm (rubber, δ = 0, ρ0 = 1.3 m)."""

from dataclasses import dataclass

from drake_formation.measuring import metrics
from drake_formation.paper.published import published
from drake_formation.paper.runs import transport
from drake_formation.paper.store import Store
from drake_formation.scenario import Scenario, with_overrides

BRACKET = (20.0, 45.0)
"""Where η is looked for (N m²)."""
TOLERANCE = 1e-3
"""To which η is found (N m²)."""


@dataclass(frozen=True, kw_only=True)
class Fit:
    """The fitted gain.

    Attributes:
        gain: η (N m²).
        error: the consensus error it gives (m).
        target: the published one (m).
        runs: how many runs it took.
    """

    gain: float
    error: float
    target: float
    runs: int


def fit(store: Store) -> Fit:
    """Find η by bracketing (Brent); one run for each try, kept in the store."""
    from scipy.optimize import root_scalar

    target = published()["line"]["consensus_error"]["rubber"][0.0] / 100
    found = root_scalar(
        lambda gain: consensus_error(store, gain) - target, bracket=BRACKET, method="brentq", xtol=TOLERANCE
    )
    return Fit(gain=found.root, error=consensus_error(store, found.root), target=target, runs=found.function_calls)


def consensus_error(store: Store, gain: float) -> float:
    """Largest consensus error (m) of the line with rubber and without consensus, at an avoidance gain (N m²)."""
    return float(metrics(store[tried(gain)]).consensus_error_m)


def tried(gain: float) -> Scenario:
    """The run at an avoidance gain (N m²)."""
    return with_overrides(transport("line", "rubber", 0.0), {"avoidance.gain": gain})
