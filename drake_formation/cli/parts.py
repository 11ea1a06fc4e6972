"""``drake-formation parts``: what the boxes of the diagram may be."""

from rich.table import Table

from drake_formation.cli.app import app
from drake_formation.terminal import say


@app.command()
def parts() -> None:
    """List the parts that the boxes of the diagram may be, and which package brings each."""
    from drake_formation.parts.registry import broken, kinds
    from drake_formation.parts.roles import ROLES

    table = Table("role", "section", "kind", "what it is", "from")
    for name, role in ROLES.items():
        section = ".".join(map(str, role.section))
        for kind, part in kinds(name).items():
            meaning = (part.__doc__ or "").splitlines()[0] if part.__doc__ else ""
            table.add_row(name, f"{section}, {role.chooser}", kind, meaning, part.distribution)
    say(table)
    for reason in dict.fromkeys(reason for name in ROLES for reason in broken(name).values()):
        say(reason)
