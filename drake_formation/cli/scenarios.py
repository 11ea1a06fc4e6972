"""``drake-formation scenarios``: what comes with the package."""

from rich.table import Table

from drake_formation.cli.app import app
from drake_formation.scenario import load_scenario, resolve, shipped_scenarios
from drake_formation.terminal import say


@app.command()
def scenarios() -> None:
    """List the scenarios that come with the package."""
    table = Table("name", "robots", "what it shows")
    for name in shipped_scenarios():
        scenario = load_scenario(name)
        table.add_row(name, str(resolve(scenario).robots), scenario.description)
    say(table)
