"""``drake-formation compare``: one scenario under several laws, and the table of what came of each."""

from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.completion import names_of
from drake_formation.cli.options import Format, FormatName, path
from drake_formation.cli.runs_bar import runs_bar
from drake_formation.terminal import FAILED_RUN, WRONG_INPUT, report, stop


@command()
def compare(
    source: Annotated[
        str,
        typer.Argument(
            metavar="COMPARISON",
            help="A comparison file, or the name of a shipped one.",
            autocompletion=names_of("comparison"),
        ),
    ],
    out: Annotated[
        Path,
        typer.Option(parser=path, metavar="FOLDER", help="For the tables (Markdown, CSV, LaTeX) and figures."),
    ],
    file_format: Format = FormatName.PNG,
    workers: Annotated[int | None, typer.Option(min=1, help="Number of processes; default: of processors.")] = None,
) -> None:
    """Run one scenario under several laws and compare them in a table and figures."""
    from drake_formation.cli.comparison_folder import COMPARISON, summary, told, write_comparison
    from drake_formation.compare import load_comparison, rows, run_comparison
    from drake_formation.places import PICTURES, OutputError, reserved
    from drake_formation.sweep import SweepStoppedError
    from drake_formation.sweep.processes import WorkerDiedError

    comparison = load_comparison(source)
    try:
        with reserved(out, COMPARISON) as place:
            with runs_bar(comparison.name) as progress:
                outcomes = run_comparison(comparison, workers=workers, progress=progress)
            table = rows(comparison, outcomes)
            written = write_comparison(place, comparison, outcomes, table, file_format.value)
    except OutputError as error:
        stop(str(error), WRONG_INPUT)
    except (SweepStoppedError, WorkerDiedError) as error:
        stop(str(error), FAILED_RUN)
    failed = [outcome for outcome in outcomes if outcome.failure]
    where = f"Tables in {written.folder}, figures in {written.folder / PICTURES}."
    failures = [f"{outcome.run.law}, {outcome.run.case}: {outcome.failure}" for outcome in failed]
    report(
        {
            "comparison": comparison.name,
            "folder": written.folder,
            "runs": [told(outcome) for outcome in outcomes],
            "remarks": written.remarks(),
        },
        *summary(comparison, table),
        "\n".join([*failures, *written.remarks(), where]),
    )
    if len(failed) == len(outcomes):
        raise SystemExit(FAILED_RUN)
