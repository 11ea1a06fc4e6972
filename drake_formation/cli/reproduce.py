"""``drake-formation reproduce``: the paper's study, run again."""

from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.options import FormatName, path
from drake_formation.cli.runs_bar import runs_bar
from drake_formation.terminal import FAILED_RUN, WRONG_INPUT, report, stop


@command()
def reproduce(
    only: Annotated[list[str] | None, typer.Option(metavar="NAME", help="A part, such as table3, fig7 or fit.")] = None,
    cell: Annotated[
        str | None,
        typer.Option(
            metavar="TABLE:MATERIAL:GAIN",
            help="Run one cell of the tables again by both readings and print it, such as table5:steel:1e4.",
        ),
    ] = None,
    out: Annotated[
        Path, typer.Option(parser=path, metavar="FOLDER", help="For the report and the runs it is made of.")
    ] = Path("out/paper"),
    file_format: Annotated[
        FormatName, typer.Option("--format", help="Of the figures; the report shows PNGs, others are beside them.")
    ] = FormatName.PNG,
    topologies: Annotated[
        bool,
        typer.Option("--topologies", help="Instead, run every communication graph that the report speaks of."),
    ] = False,
) -> None:
    """Rerun the paper's study and write a report: tables, figures and claims."""
    if [bool(only), cell is not None, topologies].count(True) > 1:
        stop("--only, --cell and --topologies ask for different things; give one of them", WRONG_INPUT)
    if topologies:
        _topologies(out / "topologies")
        return
    if cell is not None:
        _rerun(cell)
        return
    from drake_formation.paper.reproduce import reproduce as run_study
    from drake_formation.places import OutputError
    from drake_formation.simulation import SimulationError
    from drake_formation.sweep import SweepStoppedError

    with runs_bar("study") as progress:
        try:
            written = run_study(out, only or (), progress, file_format.value)
        except (OutputError, ValueError) as error:
            stop(str(error), WRONG_INPUT)
        except (SimulationError, SweepStoppedError) as error:
            stop(str(error), FAILED_RUN)
    where = f"Report in {written.folder / 'report.html'}, tables in {written.folder / 'tables.csv'}."
    report(
        {"folder": written.folder, "report": written.folder / "report.html", "remarks": written.remarks()},
        "\n".join([*written.remarks(), where]),
    )


def _topologies(folder: Path) -> None:
    """Make the result that the report's section on bandwidth rests on, and compare it with the one that is kept."""
    from drake_formation.paper.bandwidth.study import KEPT, largest_difference, run_study
    from drake_formation.sweep import SweepError, SweepStoppedError

    with runs_bar("topologies") as progress:
        try:
            found = run_study(folder, progress)
        except SweepError as error:
            stop(str(error), WRONG_INPUT)
        except SweepStoppedError as error:
            stop(str(error), FAILED_RUN)
    difference = largest_difference(found)
    report(
        {"file": folder / KEPT, "graphs": len(found), "largest_difference_cm": float(difference)},
        f"{len(found)} graphs tried, in {folder / KEPT}. Their errors differ from those that the report uses by at "
        f"most {difference:.1g} cm.",
    )


def _rerun(cell: str) -> None:
    from drake_formation.paper.rerun import rerun
    from drake_formation.simulation import SimulationError

    try:
        found = rerun(cell)
    except ValueError as error:
        stop(str(error), WRONG_INPUT)
    except SimulationError as error:
        stop(str(error), FAILED_RUN)
    report({"cell": cell, "found": found}, found)
