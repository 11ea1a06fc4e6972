"""Failures of robots: whether there are such robots, and whether what is said of them goes together."""

from collections.abc import Iterator
from itertools import combinations

from drake_formation.config.errors import Fault, shown
from drake_formation.formation.formation import Formation
from drake_formation.parts.coordination.consensus import Consensus
from drake_formation.parts.coordination.none import NoCoordination
from drake_formation.scenario.derive import robot_count
from drake_formation.scenario.failures import DROPS, Failure
from drake_formation.scenario.schema import Line, Polygon, Scenario
from drake_formation.scenario.stages import noticed, out

SECTION = "failures"


def check(scenario: Scenario) -> Iterator[Fault]:
    """Robots, times, and failures of one robot at the same time."""
    robots, begin = robot_count(scenario.formation), scenario.simulator.start_time
    for k, failure in enumerate(scenario.failures):
        if failure.robot > robots:
            yield Fault((SECTION, k, "robot"), "no such robot", shown(failure.robot), f"1 to {robots}")
        if failure.time < begin:
            message = f"the scenario begins at {begin:g} s"
            yield Fault((SECTION, k, "time"), message, shown(failure.time), f"{begin:g} s or later")
        if failure.repaired_at is not None and failure.repaired_at <= failure.time:
            message = "it is repaired before it fails"
            yield Fault(
                (SECTION, k, "repaired_at"), message, shown(failure.repaired_at), f"later than {failure.time:g} s"
            )
        if failure.response == "re_form" and not isinstance(scenario.formation, Line | Polygon):
            message = f"a formation of shape {scenario.formation.shape} has no smaller one"
            yield Fault((SECTION, k, "response"), message, "re_form", "drop_neighbour, or a line or polygon")
    for (k, first), (m, second) in combinations(enumerate(scenario.failures), 2):
        if first.robot == second.robot and _exclude(first, second) and _meet(out(first), out(second)):
            message = f"robot {first.robot} is said to be out of order at the same time in {SECTION}.{k} already"
            allowed = "failures of one robot after each other, or one of its drives and one of its load"
            yield Fault((SECTION, m, "time"), message, shown(second.time), allowed)
    if scenario.failures and not _left(scenario, robots):
        yield Fault((SECTION,), "no robot is left to form anything", allowed="re_form as long as robots are left")


def check_parts(scenario: Scenario, formation: Formation) -> Iterator[Fault]:
    """Whether the parts of robots can do what is asked of them."""
    for k, failure in enumerate(scenario.failures):
        if failure.robot > formation.robots:
            continue  # told already
        plant = formation.parts["robot"][failure.robot - 1]
        if failure.kind != DROPS and not getattr(plant, "may_fail", False):
            message = f"a robot of kind {plant.kind!r} steers by its drives, and what it does without is not modelled"
            yield Fault((SECTION, k, "kind"), message, failure.kind, f"{DROPS}, or robots of kind 'point_mass'")
        if failure.response != "carry_on":
            yield from _response(formation, k, failure)


def warnings(scenario: Scenario, formation: Formation) -> Iterator[Fault]:
    """Failures, and responses to them, that this run does not see."""
    for k, failure in enumerate(scenario.failures):
        if failure.time >= formation.end:
            message = f"the scenario ends at {formation.end:g} s, so that the robot never fails"
            yield Fault((SECTION, k, "time"), message, shown(failure.time), f"earlier than {formation.end:g} s")
        elif formation.end <= noticed(failure)[0] < float("inf"):
            message = f"the scenario ends at {formation.end:g} s, before the others notice"
            yield Fault((SECTION, k, "notice_after"), message, shown(failure.notice_after), "less")
        elif failure.repaired_at is not None and failure.repaired_at >= formation.end:
            message = f"the scenario ends at {formation.end:g} s, so that the robot is never repaired"
            yield Fault(
                (SECTION, k, "repaired_at"), message, shown(failure.repaired_at), f"earlier than {formation.end:g} s"
            )
        elif failure.kind == DROPS and out(failure)[1] <= formation.hand_off:
            message = f"it carries nothing before the hand-off at {formation.hand_off:g} s"
            yield Fault((SECTION, k, "time"), message, shown(failure.time), "after the hand-off")


def _response(formation: Formation, index: int, failure: Failure) -> Iterator[Fault]:
    """Consensus can leave a neighbour out, and follow slots that move by displacements; not all else can."""
    path = (SECTION, index, "response")
    if any(getattr(part.config, "robots", False) for part in formation.parts["avoidance"]):
        message = "robots keep away from each other by what they hear, also of one that failed"
        yield Fault(path, message, failure.response, "carry_on, or avoidance.robots false")
    for i, part in enumerate(formation.parts["coordination"]):
        if not isinstance(part, Consensus | NoCoordination):
            message = f"robot {i + 1} coordinates by {part.kind!r}, which needs to hear all that it is wired to"
            yield Fault(path, message, failure.response, "carry_on, or consensus.kind consensus or none")
            return
        if failure.response == "re_form" and isinstance(part, Consensus) and part.config.law != "linear":
            message = f"consensus.law {part.config.law!r} of robot {i + 1} goes by distances between planned slots"
            yield Fault(path, message, failure.response, "drop_neighbour, or consensus.law linear")
            return


def _exclude(first: Failure, second: Failure) -> bool:
    """Whether two failures are of the same, the drives or the load."""
    return (first.kind == DROPS) == (second.kind == DROPS)


def _meet(first: tuple[float, float], second: tuple[float, float]) -> bool:
    return first[0] < second[1] and second[0] < first[1]


def _left(scenario: Scenario, robots: int) -> bool:
    """Whether at all times some robot is not lost."""
    spans = [(failure.robot, noticed(failure)) for failure in scenario.failures if failure.response == "re_form"]
    for time in {begin for _, (begin, _) in spans}:
        if len({robot for robot, (begin, end) in spans if begin <= time < end}) >= robots:
            return False
    return True
