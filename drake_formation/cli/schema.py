"""``drake-formation schema``: the JSON Schema of a scenario."""

import json

from drake_formation.cli.app import app
from drake_formation.scenario import json_schema
from drake_formation.terminal import say


@app.command()
def schema() -> None:
    """Print the JSON Schema of a scenario, for editors."""
    say(json.dumps(json_schema(), indent=2, ensure_ascii=False))
