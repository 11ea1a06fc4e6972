"""``drake-formation new``: a scenario to start from."""

from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.completion import names_of
from drake_formation.cli.options import path
from drake_formation.terminal import WRONG_INPUT, report, stop


@command()
def new(
    name: Annotated[Path, typer.Argument(metavar="NAME", parser=path, help="Of the scenario, or the file to write.")],
    base: Annotated[
        str | None,
        typer.Option(
            "--from", metavar="SHIPPED", help="Start from a scenario that ships.", autocompletion=names_of("scenario")
        ),
    ] = None,
) -> None:
    """Write a scenario to start from, every field explained, to NAME.yaml; what is there is never overwritten."""
    from drake_formation.config.errors import did_you_mean
    from drake_formation.places import reason
    from drake_formation.scenario.starter import renamed, starter
    from drake_formation.shipped import shipped

    file = name if name.suffix in (".yaml", ".yml") else Path(f"{name}.yaml")
    known = shipped("scenario")
    if base is not None and base not in known:
        suggestion = did_you_mean(base, known) or f"; there are {', '.join(known)}"
        stop(f"--from {base}: no scenario of this name ships{suggestion}", WRONG_INPUT)
    text = starter(file.stem) if base is None else renamed(base, file.stem)
    try:
        with file.open("x", encoding="utf-8") as written:
            written.write(text)
    except FileExistsError:
        stop(f"{file}: is there already, and is left as it is; give another name", WRONG_INPUT)
    except (OSError, ValueError) as error:
        why = reason(error) if isinstance(error, OSError) else str(error)
        stop(f"{file}: cannot be written: {why}", WRONG_INPUT)
    report(
        {"file": file, "from": base},
        f"A scenario to start from is in {file}.\nNext: drake-formation show {file}, then drake-formation run {file}.",
    )
