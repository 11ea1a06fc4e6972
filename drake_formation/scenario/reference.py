"""What follows from a scenario's reference: its timing, what the planner knows, and the trajectory itself.

Every function takes a scenario that has passed :mod:`drake_formation.scenario.checks`, unless it says less.
"""

from typing import TYPE_CHECKING

import numpy as np

from drake_formation.scenario import derive
from drake_formation.scenario.derive import Array
from drake_formation.scenario.schema import (
    MinimumJerkReference,
    PotentialFieldReference,
    Scenario,
    SetPointReference,
    WaypointsReference,
)

if TYPE_CHECKING:
    from pydrake.trajectories import PiecewisePolynomial

    from drake_formation.references.potential_field import PotentialField

# What comes from Drake is imported where it is used: a scenario is read and checked without it.


def motion_duration(scenario: Scenario) -> float:
    """How long the reference takes to the goal (s); a set point takes no time."""
    reference = scenario.transport.reference
    if isinstance(reference, SetPointReference):
        return 0.0
    return scenario.transport.duration if reference.duration is None else reference.duration


def waypoint_places(scenario: Scenario, reference: WaypointsReference) -> Array:
    """Where the formation centre passes, start and goal included (m), shape (points + 2, 2)."""
    return np.vstack([derive.aggregation_centre(scenario), reference.points, scenario.transport.goal])


def known_obstacles(scenario: Scenario, reference: PotentialFieldReference) -> list[int]:
    """Indices, from 0, of the obstacles that the plan knows."""
    if reference.known == "all":
        return list(range(len(scenario.avoidance.obstacles)))
    return [number - 1 for number in reference.known]


def formation_radius(scenario: Scenario) -> float:
    """Radius of the circle about the formation centre that holds every slot (m)."""
    return float(np.linalg.norm(derive.slots(scenario), axis=1).max())


def planning_field(scenario: Scenario, reference: PotentialFieldReference) -> "PotentialField":
    """The field in which the formation centre is planned."""
    from drake_formation.references.potential_field import PotentialField

    radius = formation_radius(scenario)
    obstacles = [scenario.avoidance.obstacles[index] for index in known_obstacles(scenario, reference)]
    discs = np.array([[*obstacle.position, obstacle.radius + radius] for obstacle in obstacles], dtype=float)
    goal = np.array(scenario.transport.goal)
    return PotentialField(goal, discs.reshape(-1, 3), reference.clearance, reference.reach)


def planned(scenario: Scenario, field: "PotentialField") -> "PiecewisePolynomial":
    """The plan in a field as a Drake trajectory.

    Raises:
        StuckError: it does not reach the goal.
    """
    from drake_formation.references.potential_field import plan, plan_trajectory

    path = plan(derive.aggregation_centre(scenario), field)
    return plan_trajectory(path, field, motion_duration(scenario))


def trajectory(scenario: Scenario) -> "PiecewisePolynomial | None":
    """The motion of the formation centre as a Drake trajectory over the time since the hand-off.

    Returns:
        Position (m, shape (2, 1)); None for a set point, which does not move.
    """
    from drake_formation.references.minimum_jerk import minimum_jerk
    from drake_formation.references.waypoints import waypoint_trajectory

    match scenario.transport.reference:
        case MinimumJerkReference():
            start, goal = derive.aggregation_centre(scenario), scenario.transport.goal
            return minimum_jerk(start, goal, motion_duration(scenario))
        case WaypointsReference() as reference:
            return waypoint_trajectory(waypoint_places(scenario, reference), motion_duration(scenario))
        case PotentialFieldReference() as reference:
            return planned(scenario, planning_field(scenario, reference))
        case SetPointReference():
            return None
