"""``drake-formation graphviz``: a picture of the block diagram."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.options import Overrides, Source, path
from drake_formation.terminal import WRONG_INPUT, report, stop


class ViewName(StrEnum):
    """What a picture shows."""

    BLOCKS = "blocks"
    FORMATION = "formation"


@command()
def graphviz(
    scenario: Source,
    output: Annotated[
        Path,
        typer.Option("--output", "-o", parser=path, metavar="FILE", help="Ends in .dot, .svg, .png or .pdf."),
    ],
    overrides: Overrides = None,
    depth: Annotated[
        int | None, typer.Option(min=1, help="Of blocks: 1 shows the robots, 2 opens each of them.")
    ] = None,
    view: Annotated[
        ViewName,
        typer.Option(help="blocks: every port and wire; formation: who holds and hears whom, and one robot opened."),
    ] = ViewName.BLOCKS,
) -> None:
    """Draw a scenario's block diagram."""
    from drake_formation.diagram import build_diagram
    from drake_formation.places import OutputError, reason, reserved_file
    from drake_formation.scenario import load_scenario, resolve
    from drake_formation.viz.graphviz import write_diagram
    from drake_formation.viz.graphviz_formation import write_formation
    from drake_formation.viz.rendering import require_format

    if view is ViewName.FORMATION and depth is not None:
        stop("--depth goes with --view blocks: of a formation, one robot is opened", WRONG_INPUT)
    resolved = load_scenario(scenario, overrides=overrides)
    try:
        require_format(output)
        with reserved_file(output) as partial:
            if view is ViewName.FORMATION:
                write_formation(resolve(resolved), partial)
            else:
                write_diagram(build_diagram(resolved), partial, depth=depth or 1)
    except (ValueError, OutputError) as error:
        stop(str(error), WRONG_INPUT)
    except OSError as error:
        stop(f"{output}: cannot be written: {reason(error)}", WRONG_INPUT)
    report({"scenario": resolved.name, "file": output, "view": view.value}, f"Diagram in {output}.")
