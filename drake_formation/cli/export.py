"""``drake-formation export``: a result in other programs' formats."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.options import path
from drake_formation.terminal import WRONG_INPUT, detail, report, stop


@command()
def export(
    source: Annotated[str, typer.Argument(metavar="RESULT", help="A run's folder, or its result.nc.")],
    csv: Annotated[
        Path | None,
        typer.Option(parser=path, metavar="FILE", help="A table: a line for every time and robot, or what --of says."),
    ] = None,
    of: Annotated[
        str, typer.Option(metavar="OWNER", help="What has a line: robot, spring, obstacle, channel, node or time.")
    ] = "robot",
    mat: Annotated[Path | None, typer.Option(parser=path, metavar="FILE", help="For MATLAB: one struct.")] = None,
    mcap: Annotated[
        Path | None, typer.Option(parser=path, metavar="FILE", help="For Foxglove: its 3D panel and its plots.")
    ] = None,
    rrd: Annotated[Path | None, typer.Option(parser=path, metavar="FILE", help="For Rerun, likewise.")] = None,
) -> None:
    """Write a result in the formats of other programs: CSV, MATLAB, Foxglove, Rerun."""
    wanted = {"csv": csv, "mat": mat, "mcap": mcap, "rrd": rrd}
    files = {name: file for name, file in wanted.items() if file is not None}
    if not files:
        stop(f"nothing to write; give one or more of {', '.join(f'--{name} FILE' for name in wanted)}", WRONG_INPUT)
    if of != "robot" and csv is None:
        stop("--of goes with --csv FILE", WRONG_INPUT)
    from drake_formation.optional import MissingPackageError
    from drake_formation.places import OutputError, reserved_file
    from drake_formation.places.errors import explained
    from drake_formation.results import load_result
    from drake_formation.simulation.result import series_of

    try:
        result = load_result(source)
        series_of(result)  # says so, if it is none of this version
        own = result.formation
        write: dict[str, Callable[[Path], None]] = {
            "csv": partial(own.to_csv, of=of),
            "mat": own.to_mat,
            "mcap": own.to_mcap,
            "rrd": own.to_rrd,
        }
        for name, file in files.items():
            with reserved_file(file) as place, explained(file):
                write[name](place)
            detail(f"written: {file}")
    except (ValueError, OutputError, MissingPackageError) as error:
        stop(str(error), WRONG_INPUT)
    report({"files": files}, "\n".join(f"Result in {file}." for file in files.values()))
