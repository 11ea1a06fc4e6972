"""``drake-formation validate``: what a scenario reads as."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from drake_formation.cli.app import command
from drake_formation.cli.options import Overrides, Source
from drake_formation.terminal import report

if TYPE_CHECKING:
    from drake_formation.scenario import Scenario


@command()
def validate(scenario: Source, overrides: Overrides = None) -> None:
    """Check a scenario and say what it reads as, and what of it may not be meant."""
    from drake_formation.scenario import load_scenario, warnings
    from drake_formation.terminal.tables import table

    loaded = load_scenario(scenario, overrides=overrides)
    read, warned = list(_readings(loaded)), list(map(str, warnings(loaded)))
    shown = table("part", "reads as", title=loaded.name)
    for part, reading in read:
        shown.add_row(part, reading)
    report(
        {
            "scenario": loaded.model_dump(mode="json"),
            "reads_as": [{"part": part, "reading": reading} for part, reading in read],
            "warnings": warned,
        },
        shown,
        *(f"warning: {warning}" for warning in warned),
    )


def _readings(scenario: "Scenario") -> Iterator[tuple[str, str]]:
    """What each part of a scenario reads as."""
    from drake_formation.config.errors import shown
    from drake_formation.formation import graphs
    from drake_formation.formation.rigidity import rigid_rank, rigidity_rank
    from drake_formation.parts.roles import ROLES
    from drake_formation.scenario import resolve
    from drake_formation.scenario.owned import section

    formation = resolve(scenario)
    yield "formation", f"{scenario.formation.shape} of {formation.robots}"
    for name, graph in (("springs", formation.springs.graph), ("consensus", formation.channels.graph)):
        edges = " ".join(f"{i + 1}-{j + 1}" for i, j in graphs.edges(graph)) or "none"
        yield f"{name} edges", edges
        yield f"{name} algebraic connectivity", f"{graphs.algebraic_connectivity(graph):.4g}"
        rank = rigidity_rank(formation.slots, graphs.edges(graph))
        yield f"{name} rigidity", f"rank {rank} of {rigid_rank(formation.robots)}"
    yield "channels", str(len(formation.channels.pairs))
    for name, role in ROLES.items():
        if name == "spring" and formation.has_body:
            continue
        written = section(scenario, name)
        classes: list[Any] = sorted({type(part) for part in formation.parts[name]}, key=lambda cls: str(cls.kind))
        fields = {key: its for cls in classes for key, its in cls.Config.model_fields.items()}
        given = [_reads(key, its.description or "", getattr(written, key)) for key, its in fields.items()]
        kind = shown(getattr(written, role.chooser))
        yield ".".join(map(str, role.section)), ": ".join(filter(None, [kind, ", ".join(given)]))
    for failure in scenario.failures:
        told = f"robot {failure.robot} {failure.kind} at {failure.time:g} s; the others {failure.response}"
        yield "failures", told


def _reads(key: str, description: str, value: Any) -> str:
    """A field's name, its value, and its unit where it is one for all its numbers."""
    from drake_formation.config.errors import shown
    from drake_formation.config.labels import name_of, unit_of

    unit = unit_of(description)
    text = f"{value:g}" if isinstance(value, float) else shown(value)
    name = name_of(key, description) if unit else key
    return f"{name} = {text} {unit if unit != '1' and ',' not in unit else ''}".rstrip()
