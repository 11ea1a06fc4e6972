"""What a run amounts to, as plain arrays over time, before it is labelled or measured."""

from collections.abc import Mapping
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from drake_formation.failing import BROKEN_OUTPUTS, DRIVEN
from drake_formation.parts.objects.breaking import breaks
from drake_formation.robot_diagram import ACCELERATION, DEMANDED, HEADING, MEASURED
from drake_formation.scenario import Scenario, resolve
from drake_formation.simulation.acting import acting, may_let_go
from drake_formation.simulation.choice import Choice
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.recorder import OBJECT, OBJECT_NODES, Recording
from drake_formation.systems.consensus_error import consensus_errors
from drake_formation.vectors import length_of

Array = NDArray[np.float64]

BROKEN_AT = {False: "broken_at", True: "grip_broken_at"}
"""When each spring broke, or each grip where the object is a body of its own (s)."""
ACTING = {False: "acting", True: "grip_acting"}
"""Which of them act."""
FORCES = ("tracking_force", "consensus_force", "avoidance_force")


class Series(dict[str, Array]):
    """Arrays by the names, and with the units and dimensions, of the labelled result's variables.

    Args:
        arrays: the variables.
        scenario: what ran.
        choice: what carried it out.
    """

    def __init__(self, arrays: Mapping[str, Array], scenario: Scenario, choice: Choice) -> None:
        super().__init__(arrays)
        self.scenario = scenario
        self.choice = choice


def time_series(scenario: Scenario, choice: Choice, run: Recording, nominal: Recording | None) -> Series:
    """Everything that follows from what was recorded.

    Args:
        scenario: the scenario that ran.
        choice: what carried it out.
        run: what was recorded, at least one sample.
        nominal: the obstacle-free response from the same hand-off state; the run itself where no obstacle is felt;
            None where the run never got there.

    Returns:
        The variables of :func:`drake_formation.simulation.result.labelled_result`, and ``time`` (s).
    """
    formation = resolve(scenario)
    slots, obstacles = formation.slots, formation.obstacles
    first, second = formation.springs.pairs.T
    forces = {name: run.series(name) for name in FORCES}
    with np.errstate(over="ignore", invalid="ignore"):  # a run that diverged may end in numbers whose squares overflow
        motion = recorded_motion(scenario, run)
        position = motion.position
        lengths = length_of(position[:, first] - position[:, second])
        clearance = obstacles.clearance(position, run.times[:, None]) - formation.footprints[:, None]
        deviation = _deviation(scenario, motion, run, nominal)
    arrays = {
        "time": run.times,
        "phase": run.phases,
        "position": position,
        "velocity": motion.velocity,
        "acceleration": motion.acceleration,
        "tracking_error": run.series("tracking_error")[..., :2],
        "deviation": deviation.position,
        "deviation_velocity": deviation.velocity,
        "deviation_acceleration": deviation.acceleration,
        "consensus_error": consensus_errors(position, slots),
        **forces,
        "control_force": applied_force(run),
        "spring_force": run.series("spring_force"),
        "spring_length": lengths,
        "rest_length": formation.rest_lengths,
        "clearance": clearance,
        "slot": slots,
        "goal": formation.goal,
        "aggregation_centre": formation.centre,
        "obstacle_position": obstacles.middles,
        "obstacle_radius": obstacles.radii,
    }
    if not obstacles.are_circles:
        arrays["obstacle_outline"] = obstacles.outlines(run.times)
    if formation.footprints.any():
        arrays["robot_radius"] = formation.footprints
    if run.has(DEMANDED):
        arrays["demanded_force"] = run.series(DEMANDED)
    if run.has(MEASURED):
        measured = run.series(MEASURED)
        arrays |= {"measured_position": measured[..., :2], "measured_velocity": measured[..., 2:]}
    if formation.has_body:
        pose, strain = (run.series(name)[:, 0] for name in OBJECT)
        arrays |= {"object_pose": pose, "object_strain": strain[:, 0]}
    if run.has(OBJECT_NODES):
        arrays["object_nodes"] = run.series(OBJECT_NODES).reshape(len(run.times), -1, 2)
    if told := run.told(HEADING):
        arrays["heading"] = np.full(position.shape[:2], np.nan)
        for robot, heading in told.items():
            arrays["heading"][:, robot] = heading[:, 0]
    if run.has("traffic"):
        arrays |= {"traffic": run.series("traffic"), "channel": np.array(run.channels)}
    if breaks(formation):
        intact, broken_at = (run.series(name)[-1, 0] for name in BROKEN_OUTPUTS)
        arrays[BROKEN_AT[formation.has_body]] = np.where(intact == 1.0, np.nan, broken_at)
    if may_let_go(formation):
        broken = arrays.get(BROKEN_AT[formation.has_body])
        arrays[ACTING[formation.has_body]] = acting(formation, broken, run.times).astype(float)
    if DRIVEN in formation.signals:
        arrays["driven"] = run.series(DRIVEN)[:, 0]
        arrays["control_force"] = arrays["control_force"] * arrays["driven"][..., None]
    return Series(arrays, scenario, choice)


def applied_force(run: Recording) -> Array:
    """What the robots' actuators exert (N): all that their controllers ask for, unless something is between."""
    if run.has("control_force"):
        return run.series("control_force")
    return reduce(np.add, (run.series(name) for name in FORCES))


def recorded_motion(scenario: Scenario, run: Recording) -> Motion:
    """The motion of the robots; where they do not tell their acceleration, it is the forces on them by their mass."""
    state = run.series("state")
    position, velocity = state[..., :2], state[..., 2:]
    forces = applied_force(run) + run.series("spring_force")
    acceleration = forces / resolve(scenario).masses[:, None]
    for robot, told in run.told(ACCELERATION).items():
        acceleration[:, robot] = told
    return Motion(run.times, position, velocity, acceleration)


def _deviation(scenario: Scenario, motion: Motion, run: Recording, nominal: Recording | None) -> Motion:
    """The motion relative to the obstacle-free response, NaN where there is none."""
    nowhere = np.full_like(motion.position, np.nan)
    deviation = Motion(motion.times, nowhere, nowhere.copy(), nowhere.copy())
    if nominal is None or not len(nominal.times):
        return deviation
    known = (motion.times >= resolve(scenario).hand_off) & (motion.times <= nominal.times[-1])
    free = (
        (motion.position[known], motion.velocity[known], motion.acceleration[known])
        if nominal is run
        else recorded_motion(scenario, nominal).at_times(motion.times[known])
    )
    deviation.position[known] = motion.position[known] - free[0]
    deviation.velocity[known] = motion.velocity[known] - free[1]
    deviation.acceleration[known] = motion.acceleration[known] - free[2]
    return deviation
