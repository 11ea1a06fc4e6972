"""How long it takes until every robot stays near its slot at the goal."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport
from drake_formation.simulation.extremes import Vectors, last_beyond
from drake_formation.vectors import length_of

SETTLED = 0.02
"""A robot has settled when it stays within this share of the distance to the goal."""
SETTLED_AT_LEAST = 1e-3
"""It need not come nearer than this (m), also where the goal is where the formation is already."""


@metric("settling_time_s", label="settled within 2 % after", unit="s")
def settling_time(transport: Transport) -> float | None:
    """Time from the hand-off until every robot stays near its slot at the goal (s).

    Near is within 2 % of the distance from where the formation gathers to the goal, or within a millimetre where that
    is more, as where it is carried nowhere. 0 where no robot is ever further off, None where one is at the end.
    """
    formation, robots = transport.formation, transport.robots
    travelled = float(length_of(formation.goal - formation.centre))
    goals = formation.slots + formation.goal
    short = Vectors.of_positions(robots, transport.bulge, lambda position: position - goals)
    last = last_beyond(short, max(SETTLED * travelled, SETTLED_AT_LEAST))
    if last is None:
        return 0.0
    step, share = last
    if step == len(robots.times) - 1:
        return None
    return float(robots.times[step] + share * (robots.times[step + 1] - robots.times[step]) - robots.times[0])
