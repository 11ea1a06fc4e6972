"""``drake-formation sweep``: many runs, over grids, lists and random samples of a scenario's fields."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.completion import names_of
from drake_formation.cli.options import ENGINES_HELP, Format, FormatName, path
from drake_formation.terminal import FAILED_RUN, INTERRUPTED, WRONG_INPUT, Stopped, report, stop


class SweepEngineName(StrEnum):
    """What carries the runs of a sweep out; over many runs, compiling pays."""

    BLOCKS = "blocks"
    COMPILED = "compiled"
    EXPONENTIAL = "exponential"


class ExecutorName(StrEnum):
    """Who carries out the runs of a sweep."""

    SERIAL = "serial"
    PROCESSES = "processes"


@command()
def sweep(
    source: Annotated[
        str,
        typer.Argument(
            metavar="SWEEP", help="A sweep file, or the name of a shipped one.", autocompletion=names_of("sweep")
        ),
    ],
    out: Annotated[
        Path, typer.Option(parser=path, metavar="FOLDER", help="For the runs, the dataset and its figures.")
    ],
    engine: Annotated[SweepEngineName, typer.Option(help=f"{ENGINES_HELP}.")] = SweepEngineName.COMPILED,
    executor: Annotated[ExecutorName, typer.Option(help="This process, or several.")] = ExecutorName.PROCESSES,
    workers: Annotated[int | None, typer.Option(min=1, help="Number of processes; default: of processors.")] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Let the workers of this Dask scheduler run the sweep.")
    ] = None,
    file_format: Format = FormatName.PNG,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Run again what failed before.")] = False,
) -> None:
    """Run a scenario over grids, lists and random samples of its fields; goes on where it was stopped."""
    from drake_formation.sweep import SweepError, SweepStoppedError, load_sweep, run_sweep
    from drake_formation.sweep.terminal import closing, kept_message, progress_bar, summary, told
    from drake_formation.terminal.tables import progress_console

    loaded = load_sweep(source)
    try:
        with progress_bar(loaded.name, progress_console()) as progress:
            results = run_sweep(
                loaded, out, engine=engine.value, executor=executor.value, workers=workers, scheduler=scheduler,
                retry_failed=retry_failed, file_format=file_format.value, progress=progress,
            )  # fmt: skip
    except SweepError as error:
        stop(str(error), WRONG_INPUT)
    except SweepStoppedError as error:
        stop(f"{error}\n{kept_message(out)}", FAILED_RUN)
    except KeyboardInterrupt:
        stop(f"interrupted\n{kept_message(out)}", INTERRUPTED)
    except Stopped as reason:
        stop(f"{reason.message}\n{kept_message(out)}", reason.status)
    with results:
        message, failed = closing(results, out)
        report({"folder": out, **told(results)}, summary(results), message)
    if failed:
        raise SystemExit(FAILED_RUN)
