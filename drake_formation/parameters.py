"""The numbers of a scenario that its diagram keeps as numeric parameters in the Context.

One function says which they are. The diagram is built with them, and :func:`set_parameters` writes those of another
scenario into a Context, so that a changed gain, mass or stiffness needs no rebuild.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import Context, Diagram

from drake_formation.formation.formation import Formation
from drake_formation.formation.names import channel_name, heeding_name, robot_name
from drake_formation.parts.objects.breaking import breaking_numbers, breaks, looks_every
from drake_formation.parts.part import Part
from drake_formation.parts.roles import ROLES
from drake_formation.scenario import Scenario, resolve

Array = NDArray[np.float64]
Parameters = dict[str, tuple[Array, ...]]
"""Numeric parameters of each block in order of their indices; the key is the block's path, ``robot_1/plant``."""


def placed_parts(formation: Formation) -> Iterator[tuple[str, Part, int]]:
    """Every part that may have a block: its path in the diagram, the part, and its owner."""
    for name, role in ROLES.items():
        if role.owner == "formation":
            yield role.block, formation.parts[name][0], 0
    for i in range(formation.robots):
        for name, role in ROLES.items():
            if role.owner == "robot":
                yield f"{robot_name(i)}/{role.block}", formation.parts[name][i], i
    for k, (i, j) in enumerate(formation.channels.pairs.tolist()):
        yield channel_name(i, j), formation.parts["channel"][k], k


def block_parameters(formation: Formation) -> Parameters:
    """The numeric parameters of every block of a formation's diagram; worked out once for a formation."""
    if "numbers" not in formation.kept:
        result: Parameters = {"consensus_error": (formation.slots,), "sensing": _sensing(formation)}
        if any(getattr(part.config, "line_of_sight", False) for part in formation.parts["avoidance"]):
            layout = np.array(formation.obstacles.layout, dtype=float)
            result["line_of_sight"] = formation.obstacles.numbers, formation.footprints, layout
        result |= _failing(formation)
        for path, part, owner in placed_parts(formation):
            if groups := part.numbers(formation, owner):
                result[path] = groups
        formation.kept["numbers"] = result
    numbers: Parameters = formation.kept["numbers"]
    return numbers


def _sensing(formation: Formation) -> tuple[Array, ...]:
    """The obstacles, and where robots hold on to what they sense by how much another must be nearer (m)."""
    obstacles = formation.obstacles.numbers
    margin = max(getattr(part, "margin", 0.0) for part in formation.parts["avoidance"])
    return (obstacles, np.array([margin])) if margin else (obstacles,)


def _failing(formation: Formation) -> Parameters:
    """The numbers of what breaks and fails, as far as it does."""
    result: Parameters = {"breaking": breaking_numbers(formation)} if breaks(formation) else {}
    if formation.signals:
        result["stages"] = tuple(formation.signals.values())
    for i, j in formation.channels.pairs.tolist():
        if f"heard_{i + 1}_{j + 1}" in formation.signals:
            result[heeding_name(i, j)] = (formation.slots[i] - formation.slots[j],)
    return result


def set_parameters(diagram: Diagram, context: Context, scenario: Scenario) -> None:
    """Write a scenario's numbers into a Context of a diagram built from a scenario of the same structure.

    Afterwards the Context holds the parameters of a diagram rebuilt from that scenario; in particular a changed mass
    designs the local LQR anew. State and time are left alone.

    Args:
        diagram: from :func:`drake_formation.build_diagram`.
        context: a Context of that diagram; where it is part of another diagram, the Context of the whole.
        scenario: the scenario to take the numbers from.

    Raises:
        ScenarioError: the scenario is wrong.
        ValueError: its structure differs from the diagram's (robots, graphs, kinds of parts, sensing, number of
            obstacles, pieces of the reference, times of the hand-off and of failures); that needs a new diagram.
            Nothing has been written then.
    """
    formation = resolve(scenario)
    built: Any = getattr(diagram, "structure", None)
    if built is None:
        raise ValueError(f"diagram {diagram.get_name()!r} is not as build_diagram gave it; a clone has no structure")
    if structure(formation) != built:
        raise ValueError(
            f"scenario {scenario.name!r} has another structure than the diagram {diagram.get_name()!r}: robots, "
            "graphs, kinds of parts, sensing, number of obstacles, pieces of the reference and times of the hand-off "
            "and of failures must be alike, or the diagram built anew"
        )
    write_parameters(diagram, context, block_parameters(formation))


def write_parameters(diagram: Diagram, context: Context, parameters: Parameters) -> None:
    """Write numbers into a Context of a diagram that is known to have their blocks."""
    for path, values in parameters.items():
        if not has_block(diagram, path):
            continue
        block_context = find_block(diagram, path).GetMyMutableContextFromRoot(context)
        for index, value in enumerate(values):
            block_context.get_mutable_numeric_parameter(index).SetFromVector(np.ravel(value))


def write_start(diagram: Diagram, context: Context, formation: Formation) -> None:
    """Write the state in which a formation starts into a Context that holds the diagram's defaults."""
    for path, part, owner in placed_parts(formation):
        state, memory = part.initial_state(formation, owner), part.initial_discrete_state(formation, owner)
        if (state is None and memory is None) or not has_block(diagram, path):
            continue
        own = find_block(diagram, path).GetMyMutableContextFromRoot(context)
        if state is not None:
            own.SetContinuousState(state)
        for group, values in enumerate(memory or ()):
            own.SetDiscreteState(group, values)


def has_block(diagram: Diagram, path: str) -> bool:
    """Whether there is a block at a path: wires have none, nor have channels nobody hears and sensing nobody uses."""
    outer, _, inner = path.partition("/")
    if not diagram.HasSubsystemNamed(outer):
        return False
    return not inner or has_block(diagram.GetSubsystemByName(outer), inner)


def find_block(diagram: Diagram, path: str) -> Any:
    """The block at a path such as ``robot_1/plant``."""
    block: Any = diagram
    for name in path.split("/"):
        block = block.GetSubsystemByName(name)
    return block


def structure(formation: Formation) -> dict[str, Any]:
    """What a formation's diagram is made of: times, who hears and holds whom, and each block's kind and sizes.

    Diagrams of one structure differ in numbers alone.
    """
    result: dict[str, Any] = {
        "phase": formation.hand_off if formation.aggregation_duration else None,
        "springs": formation.springs.pairs.tolist(),
        "channels": formation.channels.pairs.tolist(),
        "law": _identity(formation.law),
        "looks": (formation.hand_off, looks_every(formation)) if breaks(formation) else None,
        "stages": [stage.time for stage in formation.stages],
        "signals": {name: np.shape(rows) for name, rows in formation.signals.items()},
    }
    numbers = block_parameters(formation)
    for path, part, owner in placed_parts(formation):
        sizes = [np.size(group) for group in numbers.get(path, ())]
        result[path] = (_identity(type(part)), part.structure(), part.layout(formation, owner), sizes)
    return result


def _identity(part: type[Part]) -> str:
    return f"{part.distribution}: {part.role} {part.kind}"
