"""The paper's claims about communication (Sec. 5.4)."""

from drake_formation.formation import graphs
from drake_formation.paper.readings.score import CLOSE
from drake_formation.paper.readings.two_readings import Reading
from drake_formation.paper.runs import FORMATIONS, GAINS, TOPOLOGIES, transport
from drake_formation.paper.store import Store
from drake_formation.paper.verdicts.verdict import FAILS, HOLDS, VACUOUS, Claim
from drake_formation.scenario import Scenario, load_scenario, resolve, with_overrides

SOURCE = f"quadrilateral, rubber, δ = {max(GAINS):g}"


def topologies_beat_local(reading: Reading, store: Store) -> Claim:
    """Sec. 5.4: every connected topology beats local LQR."""
    local = store.measured(reading.transport("quadrilateral", "rubber", 0.0)).consensus_error_m
    errors = {name: store.measured(reading.topology(name)).consensus_error_m for name in TOPOLOGIES}
    return Claim(
        claim="every connected topology beats local LQR (Sec. 5.4)",
        verdict=HOLDS if max(errors.values()) < local else FAILS,
        evidence=f"{100 * local:.2f} cm without; " + ", ".join(f"{100 * e:.2f} cm, {n}" for n, e in errors.items()),
        source=SOURCE,
    )


def ten_as_twelve(reading: Reading, store: Store) -> Claim:
    """Sec. 5.4: ten channels perform as twelve; vacuous where what the hand-off leaves hides all that channels do."""
    figures = {name: store.measured(reading.topology(name)) for name in TOPOLOGIES}
    twelve, ten, *fewer = figures.values()
    same = abs(ten.consensus_error_m - twelve.consensus_error_m) < CLOSE * twelve.consensus_error_m
    hidden = all(its.residual_m > its.disagreement_m for its in (twelve, ten))
    least = min(its.consensus_error_m for its in fewer)
    return Claim(
        claim="ten channels perform as twelve (Sec. 5.4)",
        verdict=VACUOUS if hidden else HOLDS if same else FAILS,
        evidence=(
            f"largest e {100 * ten.consensus_error_m:.2f} against {100 * twelve.consensus_error_m:.2f} cm, and "
            f"{100 * least:.2f} cm or more with fewer channels. The hand-off alone leaves "
            f"{100 * ten.residual_m:.2f} and {100 * twelve.residual_m:.2f} cm, obstacles alone "
            f"cause {100 * ten.disagreement_m:.2f} and {100 * twelve.disagreement_m:.2f} cm"
            + (": what is compared is the hand-off, not the channels" if hidden else "")
        ),
        source=SOURCE,
    )


def exponential_cost(_store: Store) -> Claim:
    """Sec. 5.4: communication cost increases exponentially with the number of nodes."""
    counts = {robots: graphs.channels(resolve(scenario).channels.graph) for robots, scenario in _complete().items()}
    quadratic = all(count == robots * (robots - 1) for robots, count in counts.items())
    listed = ", ".join(f"{count} for {robots}" for robots, count in counts.items())
    return Claim(
        claim="the cost of a complete graph increases exponentially with the number of robots (Sec. 5.4)",
        verdict=FAILS if quadratic else HOLDS,
        evidence=f"channels: {listed} robots, N(N − 1) each time: quadratic",
        source="the communication graphs of the formations, and of lines of more robots",
    )


def _complete() -> dict[int, Scenario]:
    shipped = [load_scenario(name) for name in FORMATIONS]
    longer = [_line(robots) for robots in (16, 32)]
    return {resolve(scenario).robots: scenario for scenario in [*shipped, *longer]}


def _line(robots: int) -> Scenario:
    overrides = {"formation.robots": robots, "robots.start": {"centre": [2.5, 3.5]}, "avoidance.obstacles": []}
    return with_overrides(transport("line", "rubber", 0.0), overrides)
