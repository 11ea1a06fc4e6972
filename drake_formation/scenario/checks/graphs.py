"""Who is coupled to whom, and what is given for each robot or edge."""

from collections.abc import Iterator

import networkx as nx

from drake_formation.formation.graphs import Edge, edges
from drake_formation.scenario import derive
from drake_formation.scenario.errors import Fault, Path, shortened, shown
from drake_formation.scenario.schema import Scenario


def check(scenario: Scenario) -> Iterator[Fault]:
    """Everything about graphs and the lists that go with them."""
    yield from _masses(scenario)
    yield from _springs(scenario)
    yield from _consensus(scenario)


def _masses(scenario: Scenario) -> Iterator[Fault]:
    mass, count = scenario.robots.mass, derive.robot_count(scenario.formation)
    if isinstance(mass, tuple) and len(mass) != count:
        message = f"{len(mass)} masses for {count} robots"
        yield Fault(("robots", "mass"), message, shown(mass), f"one mass (kg) for all, or {count}, one a robot")


def _springs(scenario: Scenario) -> Iterator[Fault]:
    springs = scenario.springs
    faults = list(_edges(("springs", "graph"), springs.graph, derive.robot_count(scenario.formation)))
    yield from faults
    given = {"stiffness": springs.stiffness, "damping": springs.damping}
    lists = {key: values for key, values in given.items() if isinstance(values, tuple)}
    if faults or not lists:
        return
    order = edges(derive.spring_graph(scenario))
    if not isinstance(springs.graph, str) and [_sorted(edge) for edge in springs.graph] != [_named(e) for e in order]:
        # Values are given in ascending order of the edges: an own order of edges would silently mix them up.
        message = f"edges out of order for the values of {' and '.join(lists)}"
        yield Fault(("springs", "graph"), message, shown(springs.graph), f"ascending: {_listed(order)}")
    for key, values in lists.items():
        if len(values) != len(order):
            message = f"{len(values)} values for {len(order)} edges"
            allowed = f"one for all, or {len(order)} in the order of the edges: {_listed(order)}"
            yield Fault(("springs", key), message, shown(values), allowed)


def _consensus(scenario: Scenario) -> Iterator[Fault]:
    consensus, path = scenario.consensus, ("consensus", "graph")
    faults = list(_edges(path, consensus.graph, derive.robot_count(scenario.formation)))
    yield from faults
    if faults or (consensus.delta == 0 and consensus.delta_v == 0):
        return
    groups = list(nx.connected_components(derive.communication_graph(scenario)))
    if len(groups) > 1:
        named = " and ".join("{" + ", ".join(str(robot + 1) for robot in sorted(group)) + "}" for group in groups)
        message = f"no channel between robots {shortened(named)}, so they reach no consensus (Lemma 1)"
        allowed = "a connected graph while delta or delta_v is above 0"
        yield Fault(path, message, shown(consensus.graph), allowed)


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
