"""``drake-formation graphviz``: a picture of the block diagram."""

from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import app
from drake_formation.cli.options import Overrides, Source, path
from drake_formation.scenario import load_scenario
from drake_formation.terminal import WRONG_INPUT, say, stop


@app.command()
def graphviz(
    scenario: Source,
    output: Annotated[
        Path,
        typer.Option("--output", "-o", parser=path, metavar="FILE", help="Ends in .dot, .svg, .png or .pdf."),
    ],
    overrides: Overrides = None,
    depth: Annotated[int, typer.Option(min=1, help="1 shows the robots, 2 opens each of them.")] = 1,
) -> None:
    """Draw a scenario's block diagram."""
    from drake_formation.diagram import build_diagram
    from drake_formation.places import OutputError, reason, reserved_file
    from drake_formation.viz.graphviz import write_diagram
    from drake_formation.viz.rendering import require_format

    resolved = load_scenario(scenario, overrides=overrides)
    try:
        require_format(output)
        with reserved_file(output) as partial:
            write_diagram(build_diagram(resolved), partial, depth=depth)
    except (ValueError, OutputError) as error:
        stop(str(error), WRONG_INPUT)
    except OSError as error:
        stop(f"{output}: cannot be written: {reason(error)}", WRONG_INPUT)
    say(f"Diagram in {output}.")
