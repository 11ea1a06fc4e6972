"""The parts and the metrics there are, as tables made of their classes."""

from inspect import getsourcefile
from pathlib import Path

from building.roles import in_markdown
from drake_formation.markdown import markdown_table
from drake_formation.measuring.registry import known
from drake_formation.parts import kinds
from drake_formation.parts.roles import ROLES, Port


def parts_page(root: Path) -> str:
    """Roles with their ports and kinds, each with a link to its file."""
    parts = [
        "# The parts",
        "Every box of the diagram is a part: a role, which has ports, filled by one of several kinds, which a scenario "
        "chooses. What each may be given is in [the scenario](scenario.md); "
        "`drake-formation list parts` prints this list.",
    ]
    for name, role in ROLES.items():
        section = ".".join(map(str, role.section))
        rows = [
            (f"[`{kind}`](../../{_file(part, root)}#{part.__name__})", _meaning(part), _law(part))
            for kind, part in kinds(name).items()
        ]
        parts += [
            f"## {name}",
            f"In the section `{section}`, chosen by `{role.chooser}`; one for every {role.owner}.",
            markdown_table((role.chooser, "what it is", "more"), rows),
            *_ports("Takes", role.inputs),
            *_ports("Gives", role.outputs),
        ]
    return "\n\n".join(parts) + "\n"


def metrics_page() -> str:
    """What is measured of every run."""
    rows = [
        (f"`{name}`", metric.title, metric.unit, "one a robot" if metric.each else "")
        for name, metric in known().items()
    ]
    return (
        "# The metrics\n\nEach is of the transport, between the samples too, and a key of `metrics.json`, of "
        "`drake_formation.metrics(result)` and a variable of a sweep's dataset.\n\n"
        + markdown_table(("name", "what it is", "unit", ""), rows)
        + "\n"
    )


def _file(part: type, root: Path) -> str:
    return Path(getsourcefile(part) or "").relative_to(root).as_posix()


def _meaning(part: type) -> str:
    return in_markdown((part.__doc__ or "").partition("\n\n")[0].replace("\n", " "))


def _law(part: type) -> str:
    return in_markdown(" ".join((part.__doc__ or "").partition("\n\n")[2].split()))


def _ports(verb: str, ports: tuple[Port, ...]) -> list[str]:
    if not ports:
        return []
    rows = [
        (f"`{port.name}`", str(port.size or ""), port.meaning, "always" if port.required else "where asked for")
        for port in ports
    ]
    return [markdown_table((verb, "size", "what", ""), rows)]
