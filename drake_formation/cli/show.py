"""``drake-formation show``: a scenario drawn without running it."""

from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.options import Overrides, Source, path
from drake_formation.terminal import WRONG_INPUT, report, stop

FORMATS = (".png", ".svg", ".pdf")


@command()
def show(
    scenario: Source,
    overrides: Overrides = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", parser=path, metavar="FILE", help="Ends in .png, .svg or .pdf; NAME.png if not given."
        ),
    ] = None,
    open_it: Annotated[bool, typer.Option("--open", help="Open the picture too.")] = False,
) -> None:
    """Draw a scenario without running it: start, slots and goal, springs and channels, obstacles and their range."""
    from drake_formation.places import OutputError, reserved_file
    from drake_formation.places.errors import explained
    from drake_formation.scenario import load_scenario, resolve
    from drake_formation.viz.sketch import sketch
    from drake_formation.viz.style import draw

    loaded = load_scenario(scenario, overrides=overrides)
    file = output or Path(f"{loaded.name}.png")
    if file.suffix not in FORMATS:
        stop(f"cannot draw {file.name}: the name must end in {', '.join(FORMATS)}", WRONG_INPUT)
    formation = resolve(loaded)
    try:
        with reserved_file(file) as partial, explained(file):
            draw(lambda: sketch(formation), partial)
    except OutputError as error:
        stop(str(error), WRONG_INPUT)
    report({"scenario": loaded.name, "file": file}, f"The scenario is drawn in {file}.")
    if open_it:
        typer.launch(str(file))
