"""``drake-formation metrics``: what is measured of a run."""

from rich.table import Table

from drake_formation.cli.app import app
from drake_formation.terminal import say


@app.command()
def metrics() -> None:
    """List what is measured of every run, and which package brings each."""
    from drake_formation.measuring.registry import known

    table = Table("name", "what it is", "unit", "from")
    for name, metric in known().items():
        table.add_row(name, metric.title, metric.unit, metric.distribution)
    say(table)
