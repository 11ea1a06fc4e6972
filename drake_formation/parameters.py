"""The numbers of a scenario that its diagram keeps as numeric parameters in the Context.

One function says which they are. The diagram is built with them, and :func:`set_parameters` writes those of another
scenario into a Context, so that a changed gain, mass or stiffness needs no rebuild.
"""

from collections.abc import Iterator
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import Context, Diagram

from drake_formation.formation import graphs
from drake_formation.references.trajectory import trajectory_tables
from drake_formation.scenario import Scenario, derive, reference, require_sound
from drake_formation.systems.tracking import lqr_gain

Array = NDArray[np.float64]
Parameters = dict[str, tuple[Array, ...]]
"""Numeric parameters of each block in order of their indices; the key is the block's path, ``robot_1/plant``."""


def robot_name(robot: int) -> str:
    """Name of a robot's system; robots are numbered from 1 in names and from 0 in arrays."""
    return f"robot_{robot + 1}"


def block_parameters(scenario: Scenario) -> Parameters:
    """The numeric parameters of every block of the diagram of a sound scenario."""
    slots = derive.slots(scenario)
    obstacles = obstacle_table(scenario)
    springs = spring_tables(scenario)
    talks = derive.communication_graph(scenario)
    gains = np.array([scenario.consensus.delta, scenario.consensus.delta_v])
    field = np.array([scenario.avoidance.range, scenario.avoidance.gain])
    result: Parameters = {
        "reference": reference_parameters(scenario),
        "consensus_error": (slots,),
    }
    if scenario.avoidance.sensing == "nearest":
        result["sensing"] = (obstacles[:, :2],)
    for i, mass in enumerate(derive.masses(scenario)):
        robot = robot_name(i)
        result[f"{robot}/plant"] = (np.array([mass]), springs[i])
        inertia = mass if scenario.tracking.feed_forward else 0.0
        result[f"{robot}/tracking"] = (tracking_gain(scenario, float(mass)), slots[i], np.array([inertia]))
        result[f"{robot}/consensus"] = (gains, displacements(slots, talks, i))
        result[f"{robot}/avoidance"] = (field, obstacles)
    return result


def set_parameters(diagram: Diagram, context: Context, scenario: Scenario) -> None:
    """Write a scenario's numbers into a Context of a diagram built from a scenario of the same structure.

    Afterwards the Context holds the parameters of a diagram rebuilt from that scenario; in particular a changed mass
    designs the local LQR anew. State and time are left alone.

    Args:
        diagram: from :func:`drake_formation.build_diagram`.
        context: a Context of that diagram.
        scenario: the scenario to take the numbers from.

    Raises:
        ScenarioError: the scenario is wrong.
        ValueError: its structure differs from the diagram's (robots, graphs, spring law, sensing, number of
            obstacles, pieces of the reference, time of the hand-off); that needs a new diagram. Nothing has been
            written then.
    """
    require_sound(scenario)
    if structure(scenario) != diagram_structure(diagram):
        raise ValueError(
            f"scenario {scenario.name!r} has another structure than the diagram {diagram.get_name()!r}: robots, "
            "graphs, spring law, sensing, number of obstacles, pieces of the reference and time of the hand-off must "
            "be alike, or the diagram built anew"
        )
    write_parameters(diagram, context, block_parameters(scenario))


def write_parameters(diagram: Diagram, context: Context, parameters: Parameters) -> None:
    """Write numbers into a Context of a diagram that is known to have their blocks."""
    for path, values in parameters.items():
        block_context = find_block(diagram, path).GetMyMutableContextFromRoot(context)
        for index, value in enumerate(values):
            block_context.get_mutable_numeric_parameter(index).SetFromVector(np.ravel(value))


def find_block(diagram: Diagram, path: str) -> Any:
    """The block at a path such as ``robot_1/plant``."""
    block: Any = diagram
    for name in path.split("/"):
        block = block.GetSubsystemByName(name)
    return block


def structure(scenario: Scenario, parameters: Parameters | None = None) -> dict[str, Any]:
    """What a diagram of this scenario is made of: the hand-off, each block's parameter sizes, neighbours and law.

    Args:
        scenario: a sound scenario.
        parameters: its numbers, where they are known already.
    """
    springs, talks = derive.spring_graph(scenario), derive.communication_graph(scenario)
    result: dict[str, Any] = {"phase": derive.hand_off_time(scenario) if scenario.aggregation.duration else None}
    for path, values in (parameters or block_parameters(scenario)).items():
        result[path] = [np.size(value) for value in values]
    for i in range(derive.robot_count(scenario.formation)):
        ports = [f"spring_{j + 1}" for j in graphs.neighbours(springs, i)]
        ports += [f"channel_{j + 1}" for j in graphs.neighbours(talks, i)]
        result[robot_name(i)] = (scenario.springs.law, ports)
    return result


def diagram_structure(diagram: Diagram) -> dict[str, Any]:
    """The same as :func:`structure`, read off a diagram."""
    result: dict[str, Any] = {}
    for path, block in _blocks(diagram):
        context = block.CreateDefaultContext()
        sizes = [context.get_numeric_parameter(k).size() for k in range(context.num_numeric_parameter_groups())]
        result[path] = getattr(block, "time", None) if path == "phase" else sizes
    for robot in diagram.GetSystems():
        if isinstance(robot, Diagram):
            names = [robot.get_input_port(k).get_name() for k in range(robot.num_input_ports())]
            ports = [name for name in names if name.startswith(("spring_", "channel_"))]
            result[robot.get_name()] = (robot.GetSubsystemByName("plant").law, ports)
    return result


def _blocks(diagram: Diagram) -> Iterator[tuple[str, Any]]:
    for system in diagram.GetSystems():
        if not isinstance(system, Diagram):
            yield system.get_name(), system
            continue
        for block in system.GetSystems():
            if block.get_name() != "control":
                yield f"{system.get_name()}/{block.get_name()}", block


def reference_parameters(scenario: Scenario) -> tuple[Array, Array]:
    """The reference's numbers: centre and goal of a set point (m), or the beginnings and coefficients of the pieces."""
    trajectory = reference.trajectory(scenario)
    if trajectory is None:
        return derive.aggregation_centre(scenario), np.array(scenario.transport.goal)
    return trajectory_tables(trajectory, derive.hand_off_time(scenario))


def tracking_gain(scenario: Scenario, mass: float) -> Array:
    """K_l of a robot of a mass (kg), shape (2, 4)."""
    weights = scenario.tracking
    return lqr_gain(mass, derive.cost_matrix(weights.Q, 4), derive.cost_matrix(weights.R, 2))


def obstacle_table(scenario: Scenario) -> Array:
    """Centre and radius of each obstacle (m), shape (obstacles, 3)."""
    rows = [[*obstacle.position, obstacle.radius] for obstacle in scenario.avoidance.obstacles]
    return np.array(rows, dtype=float).reshape(-1, 3)


def displacements(slots: Array, graph: nx.Graph, robot: int) -> Array:
    """Desired displacement h_i − h_j of each neighbour of a robot (m), shape (neighbours, 2)."""
    result: Array = slots[robot] - slots[graphs.neighbours(graph, robot)]
    return result


def spring_tables(scenario: Scenario) -> list[Array]:
    """For each robot its springs in port order: stiffness, damping, displacement; each of shape (neighbours, 4)."""
    graph, slots = derive.spring_graph(scenario), derive.slots(scenario)
    edges = graphs.edges(graph)
    stiffness = dict(zip(edges, derive.each(scenario.springs.stiffness, len(edges)), strict=True))
    damping = dict(zip(edges, derive.each(scenario.springs.damping, len(edges)), strict=True))
    tables = []
    for i in range(len(slots)):
        incident = [(min(i, j), max(i, j)) for j in graphs.neighbours(graph, i)]
        k, c = [stiffness[edge] for edge in incident], [damping[edge] for edge in incident]
        tables.append(np.column_stack([k, c, displacements(slots, graph, i)]))
    return tables
