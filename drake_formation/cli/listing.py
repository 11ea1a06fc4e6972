"""``drake-formation list``: what there is to name in commands and files, with a sentence each."""

from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import Annotated, Any

import typer

from drake_formation.cli.app import command
from drake_formation.cli.completion import listed
from drake_formation.terminal import WRONG_INPUT, report, stop

Row = dict[str, Any]


class What(StrEnum):
    """What is listed."""

    SCENARIOS = "scenarios"
    SWEEPS = "sweeps"
    COMPARISONS = "comparisons"
    PARTS = "parts"
    METRICS = "metrics"


def _names(context: typer.Context, incomplete: str) -> list[str]:
    return listed(str(context.params.get("what", "")), incomplete)


@command("list")
def list_there_is(
    what: Annotated[What, typer.Argument(help="What to list.")],
    names: Annotated[
        list[str] | None, typer.Argument(metavar="NAME", help="Only these.", autocompletion=_names)
    ] = None,
) -> None:
    """List the scenarios, sweeps, comparisons, parts or metrics there are, with a sentence each."""
    show(what, names or [])


def show(what: What, names: Sequence[str]) -> None:
    """List what there is.

    Args:
        what: of which kind.
        names: which of them; all if empty.
    """
    from drake_formation.config.errors import did_you_mean
    from drake_formation.terminal.tables import table

    rows, remarks = _ROWS[what](), []
    key = "kind" if what is What.PARTS else "name"
    known = {str(row[key]): None for row in rows}
    for name in names:
        if name not in known:
            stop(f"there is no {what.value.removesuffix('s')} {name!r}{did_you_mean(name, known)}", WRONG_INPUT)
    rows = [row for row in rows if not names or row[key] in names]
    if what is What.PARTS:
        remarks = _broken()
    columns = [column for column in rows[0] if column != "file"]
    shown = table(*columns)
    for row in rows:
        shown.add_row(*(str(row[column]) for column in columns))
    bare = "\n".join(dict.fromkeys(str(row[key]) for row in rows))
    report({what.value: rows, "remarks": remarks}, shown, *remarks, short=bare)


def _scenarios() -> list[Row]:
    from drake_formation.scenario import load_scenario, resolve, shipped_scenarios

    loaded = {name: (file, load_scenario(file)) for name, file in shipped_scenarios().items()}
    return [
        {"name": name, "robots": resolve(scenario).robots, "what it shows": scenario.description, "file": file}
        for name, (file, scenario) in loaded.items()
    ]


def _files(kind: str) -> list[Row]:
    """Sweeps or comparisons; they are read, and not yet checked, for that takes a while."""
    from drake_formation.scenario.source import read
    from drake_formation.shipped import shipped

    found = {name: (file, read(file).data) for name, file in shipped(kind).items()}
    return [
        {"name": name, "scenario": data["scenario"], "what it shows": data["description"], "file": file}
        for name, (file, data) in found.items()
    ]


def _parts() -> list[Row]:
    from drake_formation.parts.registry import kinds
    from drake_formation.parts.roles import ROLES

    return [
        {
            "kind": kind,
            "role": name,
            "section": f"{'.'.join(map(str, role.section))}, {role.chooser}",
            "what it is": _sentence(part.__doc__),
            "from": part.distribution,
        }
        for name, role in ROLES.items()
        for kind, part in kinds(name).items()
    ]


def _broken() -> list[str]:
    """Why parts of installed packages cannot be used."""
    from drake_formation.parts.registry import broken
    from drake_formation.parts.roles import ROLES

    reasons: Iterator[str] = (reason for name in ROLES for reason in broken(name).values())
    return list(dict.fromkeys(reasons))


def _metrics() -> list[Row]:
    from drake_formation.measuring.registry import known

    return [
        {
            "name": name,
            "label": metric.title,
            "unit": metric.unit,
            "what it is": _sentence(metric.law.__doc__) or metric.label,
            "from": metric.distribution,
        }
        for name, metric in known().items()
    ]


def _sentence(docstring: str | None) -> str:
    return (docstring or "").strip().partition("\n")[0]


_ROWS = {
    What.SCENARIOS: _scenarios,
    What.SWEEPS: lambda: _files("sweep"),
    What.COMPARISONS: lambda: _files("comparison"),
    What.PARTS: _parts,
    What.METRICS: _metrics,
}
