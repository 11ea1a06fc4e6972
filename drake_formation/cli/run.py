"""``drake-formation run``: a scenario, from its file to its metrics, result, diagram and figures."""

from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.film import filming
from drake_formation.cli.options import ENGINES_HELP, EngineName, Format, FormatName, Overrides, Source, path
from drake_formation.cli.simulating import progress_bar, simulate_with_progress
from drake_formation.terminal import FAILED_RUN, WRONG_INPUT, detail, report, stop

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

    from drake_formation.measuring import Metrics
    from drake_formation.measuring.check import Check
    from drake_formation.scenario import Scenario


@command()
def run(
    scenario: Source,
    overrides: Overrides = None,
    out: Annotated[
        Path | None, typer.Option(parser=path, metavar="FOLDER", help="For the results; out/NAME if not given.")
    ] = None,
    engine: Annotated[
        EngineName, typer.Option(help=f"{ENGINES_HELP}; auto: blocks or compiled, whichever is done first.")
    ] = EngineName.AUTO,
    file_format: Format = FormatName.PNG,
    film: Annotated[
        Path | None,
        typer.Option("--animate", parser=path, metavar="FILE", help="Write a film too; ends in .mp4 or .gif."),
    ] = None,
    csv: Annotated[
        Path | None,
        typer.Option(parser=path, metavar="FILE", help="Write a table too: a line for every time and robot."),
    ] = None,
    check: Annotated[bool, typer.Option("--check", help="Run it again, more accurately, and compare.")] = False,
) -> None:
    """Run a scenario and write its metrics, result, diagram and figures."""
    from drake_formation.cli.run_folder import RUN, write_check, write_failed_run, write_run
    from drake_formation.exporting.csv_file import write_csv
    from drake_formation.lowering.errors import LoweringError
    from drake_formation.measuring import metrics
    from drake_formation.places import PICTURES, OutputError, reserved, reserved_file
    from drake_formation.places.errors import explained
    from drake_formation.scenario import load_scenario, warnings
    from drake_formation.simulation import SimulationError, events
    from drake_formation.viz.errors import FilmError

    resolved = load_scenario(scenario, overrides=overrides)
    try:
        with (
            filming(film) as shoot,
            reserved_file(csv) if csv else nullcontext() as table,
            reserved(out or Path("out") / resolved.name, RUN) as place,
        ):
            try:
                result = simulate_with_progress(resolved, engine)
                why = result.attrs.get("engine_reason", "as asked for")
                detail(f"simulated by the engine {result.attrs['engine']}: {why}")
                figures = metrics(result)
                detail("measured")
            except SimulationError as error:
                kept = write_failed_run(place, resolved, error.partial, str(error), file_format.value)
                recorded = f"What was recorded until then is in {kept.folder}."
                stop("\n".join([str(error), *kept.remarks(), recorded]), FAILED_RUN)
            written = write_run(place, resolved, result, figures, file_format.value)
            detail(f"written: {written.folder}")
            shoot(result)
            if csv and table:
                with explained(csv):
                    write_csv(result, table)
        checked = _check_with_progress(resolved, result) if check else None
        if checked:
            write_check(written.folder, checked)
    except (OutputError, LoweringError, FilmError) as error:
        stop(str(error), WRONG_INPUT)
    what_happened, warned = events(result), list(map(str, warnings(resolved)))
    remarks = [*([str(result.attrs["remark"])] if "remark" in result.attrs else []), *written.remarks()]
    places = [f"Results in {written.folder}, pictures in {written.folder / PICTURES}."]
    places += [*([f"Film in {film}."] if film else []), *([f"Table in {csv}."] if csv else [])]
    report(
        {
            "scenario": resolved.name,
            "folder": written.folder,
            "engine": result.attrs["engine"],
            "engine_reason": result.attrs.get("engine_reason"),
            "metrics": figures.to_dict(),
            "check": checked and checked.to_dict(),
            "events": [event.to_dict() for event in what_happened],
            "warnings": warned,
            "remarks": remarks,
            "film": film,
            "table": csv,
        },
        _summary(result, figures, checked),
        f"engine {result.attrs['engine']}: {why}",
        "\n".join([*map(str, what_happened), *(f"warning: {warning}" for warning in warned), *remarks, *places]),
    )


def _check_with_progress(scenario: "Scenario", result: "xr.Dataset") -> "Check":
    from drake_formation.measuring.check import check
    from drake_formation.simulation import SimulationError

    try:
        with progress_bar(scenario, f"check of {scenario.name}") as progress:
            return check(scenario, result, progress=progress)
    except SimulationError as error:
        stop(f"The run is complete, but its check is not: {error}", FAILED_RUN)


def _summary(result: "xr.Dataset", figures: "Metrics", check: "Check | None") -> "Table":
    from drake_formation.measuring.registry import known
    from drake_formation.terminal.tables import table

    columns = ("metric", "value", "unit") + (("check differs by",) if check else ())
    summary = table(*columns, title=f"{result.attrs['title']}, transport")
    for name, metric in known().items():
        if figures[name] is None:  # nothing to measure
            continue
        summary.add_row(
            metric.title, _number(figures[name]), metric.unit, *([_number(check.metrics[name])] if check else [])
        )
    if check:
        summary.add_row("positions at any time", "", "m", _number(check.position_difference_m))
    return summary


def _number(value: float | list[float] | None) -> str:
    if value is None:
        return "none"
    return ", ".join(f"{number:.4g}" for number in value) if isinstance(value, list) else f"{value:.4g}"
