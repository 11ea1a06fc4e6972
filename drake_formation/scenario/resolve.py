"""From what was written to what it means: a scenario resolved into a formation, once."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from drake_formation.config.each import Owners
from drake_formation.config.errors import Fault
from drake_formation.formation.formation import Formation
from drake_formation.formation.links import Channels, Edges
from drake_formation.parts.part import Part
from drake_formation.parts.registry import kinds
from drake_formation.parts.roles import ROLES
from drake_formation.scenario import derive
from drake_formation.scenario.checks import failures, geometry, graphs, obstacles, simulator
from drake_formation.scenario.owned import handed_out, path_of
from drake_formation.scenario.schema import Scenario
from drake_formation.scenario.source import Document
from drake_formation.scenario.stages import stages

KEPT = "_resolved"
"""Where a scenario keeps what it was resolved into: beside its fields, so that equality does not look at it."""


@dataclass(frozen=True, eq=False)
class _Kept:
    scenario: Scenario
    formation: Formation


def resolve(scenario: Scenario) -> Formation:
    """What a scenario means, as plain arrays and parts.

    It is computed once for a scenario, and checked on the way: a formation is sound.

    Raises:
        ScenarioError: with all faults that concern several fields; pydantic has checked the single ones.
    """
    kept = scenario.__dict__.get(KEPT)
    if kept is None or kept.scenario is not scenario:  # a copy is another scenario
        if faults := check(scenario):
            raise Document(f"scenario {scenario.name!r}", {}).attributed(faults)
        kept = scenario.__dict__[KEPT]
    formation: Formation = kept.formation
    return formation


def warnings(scenario: Scenario) -> list[Fault]:
    """What a scenario says that can be run but may not be meant.

    Raises:
        ScenarioError: the scenario is wrong.
    """
    formation = resolve(scenario)
    of_parts = _placed(scenario, formation.warnings_of_parts())
    return list(dict.fromkeys([*of_parts, *failures.warnings(scenario, formation)]))


def check(scenario: Scenario) -> list[Fault]:
    """All faults that concern several fields at once; none for a scenario that resolves, which it then has.

    Args:
        scenario: its single fields are valid, as pydantic leaves them.
    """
    if faults := [*geometry.size(scenario), *obstacles.check(scenario)]:
        return faults  # without a number of robots, or with obstacles that are none, nothing else can be said
    places = list(geometry.check(scenario))
    links = list(graphs.check(scenario))
    failing = list(failures.check(scenario))
    owners = _owners(scenario, sound=not links)
    parts, handing = _parts(scenario, owners)
    formation = _formation(scenario, parts, owners, sound=not places and not links)
    if not places and not failing:
        formation = formation.changed(stages=stages(scenario))
    skipped = {"reference", *(["coordination"] if links else []), *(["object"] if places or links else [])}
    skipped |= {"medium"} if links or handing else set()  # what shares it is not known
    faults = list(dict.fromkeys([
        *places,
        *(_part_faults(scenario, formation, ("reference",)) if not places else ()),  # it begins and ends at places
        *handing,
        *links,
        *_part_faults(scenario, formation, tuple(role for role in ROLES if role not in skipped)),
        *failing,
        *failures.check_parts(scenario, formation),
        *simulator.check(scenario),
    ]))  # fmt: skip
    if not faults:
        scenario.__dict__[KEPT] = _Kept(scenario, formation)
    return faults


def _owners(scenario: Scenario, *, sound: bool) -> dict[str, Owners]:
    robots = derive.robot_count(scenario.formation)
    edges = derive.spring_edges(scenario).pairs.tolist() if sound else []
    channels = derive.channels(scenario) if sound else Channels.of(robots, [])
    return {
        "robot": Owners.robots(robots),
        "edge": Owners.edges([(i, j) for i, j in edges]),
        "channel": Owners("channel", channels.labels),
        "formation": Owners("formation", ("formation",)),
    }


def _parts(scenario: Scenario, owners: dict[str, Owners]) -> tuple[dict[str, tuple[Part, ...]], list[Fault]]:
    """The parts of every role, with defaults where a role has faults, and the faults."""
    parts, faults = {}, []
    for name, role in ROLES.items():
        its = owners[role.owner]
        parts[name], wrong = handed_out(scenario, name, its)
        if wrong:
            faults += wrong
            default = kinds(name)[role.default]
            parts[name] = (default(default.Config()),) * len(its.names)
    return parts, faults


def _formation(
    scenario: Scenario, parts: dict[str, tuple[Part, ...]], owners: dict[str, Owners], *, sound: bool
) -> Formation:
    """The formation; where places or links are not sound, one that serves to check the rest alone."""
    robots = derive.robot_count(scenario.formation)
    slots = derive.slots(scenario) if sound else np.zeros((robots, 2))
    starts = derive.starts(scenario) if sound else slots
    linked = len(owners["edge"].names) or len(owners["channel"].names) or sound
    return Formation(
        name=scenario.name,
        slots=slots,
        starts=starts,
        centre=starts.mean(axis=0),
        goal=np.array(scenario.transport.goal),
        springs=derive.spring_edges(scenario) if linked else Edges(robots, np.zeros((0, 2), dtype=np.int64)),
        channels=derive.channels(scenario) if linked else Channels.of(robots, []),
        obstacles=derive.obstacles(scenario),
        footprints=derive.footprints(scenario),
        begin=scenario.simulator.start_time,
        aggregation_duration=scenario.aggregation.duration,
        transport_duration=scenario.transport.duration,
        law=kinds("spring")[scenario.springs.law],
        seed=scenario.seed,
        tolerance=scenario.transport.tolerance,
        parts=parts,
    )


def _part_faults(scenario: Scenario, formation: Formation, roles: tuple[str, ...]) -> Iterator[Fault]:
    yield from _placed(scenario, formation.faults_of_parts(roles))


def _placed(scenario: Scenario, found: Iterable[tuple[str, int, Fault]]) -> Iterator[Fault]:
    """Faults of parts with their paths in the scenario."""
    for role, owner, fault in found:
        yield Fault(
            path_of(scenario, role, owner, fault.path), fault.message, fault.value, fault.allowed, fault.suggestion
        )
