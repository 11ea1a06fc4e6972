"""Who is coupled to whom, and what is given for each robot or edge."""

from collections.abc import Iterator
from typing import Any

from drake_formation.config.errors import Fault, Path, shortened, shown
from drake_formation.formation.formation import SPRINGS
from drake_formation.formation.graphs import Edge, edges
from drake_formation.parts.registry import kinds
from drake_formation.scenario import derive
from drake_formation.scenario.schema import Scenario


def check(scenario: Scenario) -> Iterator[Fault]:
    """Whether graphs join robots that there are, each two once."""
    yield from _springs(scenario)
    yield from _channels(scenario)


def _springs(scenario: Scenario) -> Iterator[Fault]:
    springs, kind = scenario.springs, scenario.object.kind
    if kind != SPRINGS:
        if scenario.speaks_of_springs:
            message = f"the carried object is {kind!r} and has no springs"
            yield Fault(("springs",), message, allowed="nothing here ({}), or object.kind springs")
        return
    faults = list(_edges(("springs", "graph"), springs.graph, derive.robot_count(scenario.formation)))
    yield from faults
    fields = kinds("spring")[springs.law].Config.model_fields
    lists = [name for name in fields if isinstance(getattr(springs, name), tuple)]
    if faults or not lists or isinstance(springs.graph, str):
        return
    order = edges(derive.spring_graph(scenario))
    if [_sorted(edge) for edge in springs.graph] != [_named(e) for e in order]:
        # Values are given in ascending order of the edges: an own order of edges would silently mix them up.
        message = f"edges out of order for the values of {' and '.join(lists)}"
        yield Fault(("springs", "graph"), message, shown(springs.graph), f"ascending: {_listed(order)}")


def _channels(scenario: Scenario) -> Iterator[Fault]:
    graph, path = scenario.consensus.graph, ("consensus", "graph")
    count = derive.robot_count(scenario.formation)
    if isinstance(graph, str):
        return
    seen: dict[Edge, int] = {}
    for index, link in enumerate(graph):
        here = (*path, index)
        ways = (link, link[::-1]) if isinstance(link, tuple) else ((link.listener, link.speaker),)
        if fault := _ends(here, ways[0], count, link):
            yield fault
            continue
        if twice := next((way for way in ways if way in seen), None):
            yield _twice(here, link, graph[seen[twice]], seen[twice], twice)
        seen.update(dict.fromkeys(ways, index))


def _twice(path: Path, link: Any, other: Any, entry: int, way: Edge) -> Fault:
    if isinstance(link, tuple) and isinstance(other, tuple):
        message, allowed = f"the same edge as entry {entry}", "every edge once; edges have no direction"
    else:
        listener, speaker = way
        message = f"a second channel from robot {speaker} to robot {listener}, after entry {entry}"
        allowed = "one channel an edge and direction; [i, j] is one each way"
    return Fault(path, message, shown(_plain(link)), allowed)


def _plain(link: Any) -> Any:
    return link if isinstance(link, tuple) else link.model_dump()


def _ends(path: Path, ends: Edge, count: int, link: Any) -> Fault | None:
    outside = [str(robot) for robot in _ordered(link) if not 1 <= robot <= count]
    if outside:
        return Fault(path, f"there is no robot {outside[0]}", shown(_plain(link)), f"two of the robots 1 to {count}")
    if ends[0] == ends[1]:
        return Fault(path, "an edge from a robot to itself", shown(_plain(link)), f"two of the robots 1 to {count}")
    return None


def _ordered(link: Any) -> Edge:
    return link if isinstance(link, tuple) else (link.speaker, link.listener)


def _edges(path: Path, graph: str | tuple[Edge, ...], count: int) -> Iterator[Fault]:
    """Edges one by one: between two of the robots, and each once."""
    seen: dict[Edge, int] = {}
    for index, edge in enumerate(() if isinstance(graph, str) else graph):
        here = (*path, index)
        outside = [str(robot) for robot in edge if not 1 <= robot <= count]
        if outside:
            yield Fault(here, f"there is no robot {outside[0]}", shown(edge), f"two of the robots 1 to {count}")
        elif edge[0] == edge[1]:
            yield Fault(here, "an edge from a robot to itself", shown(edge), f"two of the robots 1 to {count}")
        elif _sorted(edge) in seen:
            message = f"the same edge as entry {seen[_sorted(edge)]}"
            yield Fault(here, message, shown(edge), "every edge once; edges have no direction")
        else:
            seen[_sorted(edge)] = index


def _sorted(edge: Edge) -> Edge:
    return min(edge), max(edge)


def _named(edge: Edge) -> Edge:
    """An edge in users' numbers, from 1."""
    return edge[0] + 1, edge[1] + 1


def _listed(order: list[Edge]) -> str:
    return shortened(", ".join(f"{i}-{j}" for i, j in map(_named, order))) or "none"
