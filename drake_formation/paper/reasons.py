"""Why a cell differs by more than it should, in numbers of the runs and of the paper."""

from drake_formation.measuring import Metrics
from drake_formation.paper.published import published
from drake_formation.paper.readings.score import AGREES
from drake_formation.paper.readings.two_readings import READINGS, Place
from drake_formation.paper.store import Measures
from drake_formation.scenario import resolve


def reason(reading: str, place: Place, store: Measures) -> str:
    """Why a cell of a reading differs from the published number."""
    return _REASONS[place.quantity](reading, place, store)


def _tracking(_reading: str, place: Place, store: Measures) -> str:
    ours = [100 * _figures(reading, place, store).stacked_tracking_error_m for reading in READINGS]
    if place.delta == 0:
        return "how far an obstacle pushes depends on ρ0 and η, which are fitted to one other number"
    if place.formation == "line":
        return "with consensus both robots share each push; how much of it they get depends on how soft and wide it is"
    return (
        "with consensus ε does not depend on the material or on δ "
        f"(here {ours[0]:.1f} and {ours[1]:.1f} cm by the two readings), and the published ε does"
    )


def _consensus(reading: str, place: Place, store: Measures) -> str:
    figures = _figures(reading, place, store)
    if place.material == "steel" and place.delta == 0:
        return (
            f"steel holds the distances (Eq. 2): of e = {100 * figures.consensus_error_m:.2f} cm the turning of the "
            f"formation is {100 * figures.turned_m:.2f} cm; the published {_printed(place):g} cm are not explained"
        )
    if place.delta > 0 and figures.residual_m > figures.disagreement_m:
        return (
            f"e is what the hand-off leaves (here {100 * figures.residual_m:.2f} cm), which depends on T_agg and on "
            "the phase in which springs ring then"
        )
    return "how far one robot is pushed away from the others depends on ρ0 and η, fitted to the line"


def _force(reading: str, place: Place, store: Measures) -> str:
    figures = _figures(reading, place, store)
    if place.delta == 0:
        return (
            f"the local LQR answers the springs' push at the hand-off: {figures.peak_force_n:.1f} N here, "
            f"{_printed(place):g} N published"
        )
    run = READINGS[reading].transport(place.formation, place.material, place.delta)
    error = published()[place.formation]["consensus_error"][place.material][place.delta] / 100
    cost = place.delta * resolve(run).robots * error
    if run.consensus.law == "linear" and cost > (1 + AGREES) * _printed(place):
        return (
            f"virtual springs on displacements resist turning too, so that the published e of {100 * error:g} cm costs "
            f"about δ·N·e = {cost:.0f} N; springs along lines leave the formation free to turn, and it costs none"
        )
    return (
        f"the peak is what the virtual springs are out of place at the hand-off, times δ: {figures.peak_force_n:.0f} N "
        f"here, {_printed(place):g} N published"
    )


def _figures(reading: str, place: Place, store: Measures) -> Metrics:
    return store.measured(READINGS[reading].transport(place.formation, place.material, place.delta))


def _printed(place: Place) -> float:
    number: float = published()[place.formation][place.quantity][place.material][place.delta]
    return number


_REASONS = {"tracking_error": _tracking, "consensus_error": _consensus, "peak_force": _force}
