"""``drake-formation validate``: what a scenario reads as."""

from typing import Any

from rich.table import Table

from drake_formation.cli.app import app
from drake_formation.cli.options import Overrides, Source
from drake_formation.formation import graphs
from drake_formation.formation.rigidity import rigid_rank, rigidity_rank
from drake_formation.scenario import Scenario, load_scenario, resolve, warnings
from drake_formation.terminal import say


@app.command()
def validate(scenario: Source, overrides: Overrides = None) -> None:
    """Check a scenario and say what it reads as, and what of it may not be meant."""
    loaded = load_scenario(scenario, overrides=overrides)
    say(_description(loaded))
    for warning in warnings(loaded):
        say(f"warning: {warning}")


def _description(scenario: Scenario) -> Table:
    """What a scenario reads as."""
    from drake_formation.config.errors import shown
    from drake_formation.parts.roles import ROLES
    from drake_formation.scenario.owned import section

    formation = resolve(scenario)
    table = Table("part", "reads as", title=scenario.name)
    table.add_row("formation", f"{scenario.formation.shape} of {formation.robots}")
    for name, graph in (("springs", formation.springs.graph), ("consensus", formation.channels.graph)):
        edges = " ".join(f"{i + 1}-{j + 1}" for i, j in graphs.edges(graph)) or "none"
        table.add_row(f"{name} edges", edges)
        table.add_row(f"{name} algebraic connectivity", f"{graphs.algebraic_connectivity(graph):.4g}")
        rank = rigidity_rank(formation.slots, graphs.edges(graph))
        table.add_row(f"{name} rigidity", f"rank {rank} of {rigid_rank(formation.robots)}")
    table.add_row("channels", str(len(formation.channels.pairs)))
    for name, role in ROLES.items():
        if name == "spring" and formation.has_body:
            continue
        written = section(scenario, name)
        classes: list[Any] = sorted({type(part) for part in formation.parts[name]}, key=lambda cls: str(cls.kind))
        fields = {key: its for cls in classes for key, its in cls.Config.model_fields.items()}
        given = [_reads(key, its.description or "", getattr(written, key)) for key, its in fields.items()]
        kind = shown(getattr(written, role.chooser))
        table.add_row(".".join(map(str, role.section)), ": ".join(filter(None, [kind, ", ".join(given)])))
    for failure in scenario.failures:
        told = f"robot {failure.robot} {failure.kind} at {failure.time:g} s; the others {failure.response}"
        table.add_row("failures", told)
    return table


def _reads(name: str, description: str, value: Any) -> str:
    """A field with its value, its symbol and its unit, as far as its description has them."""
    from drake_formation.config.errors import shown

    label, _, rest = description.partition(" (")
    unit, closed, _ = rest.partition(")")
    text = f"{value:g}" if isinstance(value, float) else shown(value)
    return f"{label} = {text} {unit}" if closed and len(label) < 40 else f"{name} = {text}"
