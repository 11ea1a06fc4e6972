"""The command line: ``drake-formation run | sweep | analyze | validate | graphviz | reproduce | schema | …``."""

import json
import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from drake_formation.formation import graphs
from drake_formation.scenario import (
    Scenario,
    ScenarioError,
    derive,
    json_schema,
    load_scenario,
    shipped_scenarios,
)

if TYPE_CHECKING:
    import xarray as xr

WRONG_INPUT, FAILED_RUN, INTERRUPTED = 2, 3, 130
"""Exit statuses beside 0."""

app = typer.Typer(
    help="Cooperative transport by hierarchical decentralized LQR, as a Drake block diagram.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
Source = Annotated[str, typer.Argument(metavar="SCENARIO", help="A scenario file, or the name of a shipped one.")]
Overrides = Annotated[
    list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="Replace a field, e.g. springs.stiffness=3e4.")
]
console = Console()


class EngineName(StrEnum):
    """What carries a run out."""

    BLOCKS = "blocks"
    COMPILED = "compiled"
    EXPONENTIAL = "exponential"


Engine = Annotated[
    EngineName,
    typer.Option(help="The block diagram itself, or code compiled from it, integrated by steps or exponentially."),
]


class ExecutorName(StrEnum):
    """Who carries out the runs of a sweep."""

    SERIAL = "serial"
    PROCESSES = "processes"


def main() -> None:
    """Entry point of the command; turns what a user can do wrong into a message and an exit status."""
    try:
        app()
    except ScenarioError as error:
        _stop(str(error), WRONG_INPUT)
    except KeyboardInterrupt:
        _stop("interrupted", INTERRUPTED)


@app.command()
def run(
    scenario: Source,
    overrides: Overrides = None,
    out: Annotated[Path | None, typer.Option(help="Folder for the results; out/NAME if not given.")] = None,
    engine: Engine = EngineName.BLOCKS,
) -> None:
    """Run a scenario and write its metrics, result, diagram and figures."""
    from drake_formation.lowering.errors import LoweringError
    from drake_formation.metrics import metrics
    from drake_formation.output import OutputError, require_place, write_failed_run, write_run
    from drake_formation.simulation import SimulationError

    resolved = load_scenario(scenario, overrides=overrides)
    folder = out or Path("out") / resolved.name
    try:
        require_place(folder)
        result = _simulate_with_progress(resolved, engine)
        figures = metrics(result)
        write_run(folder, resolved, result, figures)
    except SimulationError as error:
        kept = write_failed_run(folder, resolved, error.partial, str(error))
        _stop(f"{error}\nWhat was recorded until then is in {kept}.", FAILED_RUN)
    except (OutputError, LoweringError) as error:
        _stop(str(error), WRONG_INPUT)
    console.print(_summary(resolved, figures.to_dict()))
    if remark := result.attrs.get("remark"):
        console.print(remark, soft_wrap=True)
    console.print(f"Results in {folder}, pictures in {folder / 'figures'}.", soft_wrap=True)


@app.command()
def sweep(
    source: Annotated[str, typer.Argument(metavar="SWEEP", help="A sweep file, or the name of a shipped one.")],
    out: Annotated[Path, typer.Option(help="Folder for the runs, the dataset and its figures.")],
    engine: Engine = EngineName.COMPILED,
    executor: Annotated[ExecutorName, typer.Option(help="This process, or several.")] = ExecutorName.PROCESSES,
    workers: Annotated[int | None, typer.Option(min=1, help="Number of processes; default: of processors.")] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Let the workers of this Dask scheduler run the sweep.")
    ] = None,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Run again what failed before.")] = False,
) -> None:
    """Run a scenario over grids, lists and random samples of its fields; goes on where it was stopped."""
    from drake_formation.sweep import SweepError, SweepStoppedError, load_sweep, run_sweep
    from drake_formation.sweep.terminal import closing, kept_message, progress_bar, summary

    loaded = load_sweep(source)
    try:
        with progress_bar(loaded.name, Console(stderr=True)) as progress:
            results = run_sweep(
                loaded, out, engine=engine.value, executor=executor.value, workers=workers, scheduler=scheduler,
                retry_failed=retry_failed, progress=progress,
            )  # fmt: skip
    except SweepError as error:
        _stop(str(error), WRONG_INPUT)
    except SweepStoppedError as error:
        _stop(f"{error}\n{kept_message(out)}", FAILED_RUN)
    except KeyboardInterrupt:
        _stop(f"interrupted\n{kept_message(out)}", INTERRUPTED)
    with results:
        message, failed = closing(results, out)
        console.print(summary(results))
    console.print(message, soft_wrap=True)
    if failed:
        raise SystemExit(FAILED_RUN)


@app.command()
def analyze(
    scenario: Source,
    overrides: Overrides = None,
    out: Annotated[Path | None, typer.Option(help="Folder for the certificate and its figures, if wanted.")] = None,
    period: Annotated[float | None, typer.Option(help="Sampling period of the loss margin (s).")] = None,
    damping_ratio: Annotated[float | None, typer.Option(help="Find the smallest δ with this damping ratio.")] = None,
    decay_rate: Annotated[float | None, typer.Option(help="Find the smallest δ with this decay rate (1/s).")] = None,
    force_limit: Annotated[float | None, typer.Option(help="Find the largest δ under this force (N).")] = None,
    topology: Annotated[float | None, typer.Option(help="Find the fewest channels for this error (m).")] = None,
) -> None:
    """Certify a scenario before it is simulated: stability, modes, margins and what disturbances do."""
    from drake_formation.analysis import IllPosedError, Questions, certify
    from drake_formation.analysis.report import report
    from drake_formation.analysis_output import CERTIFICATE, closing, write_certificate
    from drake_formation.output import OutputError, require_place

    resolved = load_scenario(scenario, overrides=overrides)
    try:
        asked = Questions(period, damping_ratio, decay_rate, force_limit, topology)
        if out:
            require_place(out, mark=CERTIFICATE)
        with Console(stderr=True).status("linearizing") as status:
            certificate = certify(resolved, questions=asked, progress=lambda part: status.update(f"analyzing: {part}"))
            left_out = write_certificate(out, certificate) if out else {}
    except (OutputError, IllPosedError) as error:
        _stop(str(error), WRONG_INPUT)
    console.print(report(certificate))
    if out:
        console.print(closing(out, left_out), soft_wrap=True)


@app.command()
def validate(scenario: Source, overrides: Overrides = None) -> None:
    """Check a scenario and say what it reads as."""
    console.print(_description(load_scenario(scenario, overrides=overrides)))


@app.command()
def graphviz(
    scenario: Source,
    output: Annotated[Path, typer.Option("--output", "-o", help="File ending in .dot, .svg, .png or .pdf.")],
    overrides: Overrides = None,
    depth: Annotated[int, typer.Option(min=1, help="1 shows the robots, 2 opens each of them.")] = 1,
) -> None:
    """Draw a scenario's block diagram."""
    from drake_formation.diagram import build_diagram
    from drake_formation.viz.graphviz import write_diagram

    diagram = build_diagram(load_scenario(scenario, overrides=overrides))
    try:
        write_diagram(diagram, output, depth=depth)
    except (ValueError, OSError) as error:
        _stop(str(error), WRONG_INPUT)
    console.print(f"Diagram in {output}.", soft_wrap=True)


@app.command()
def reproduce(
    only: Annotated[list[str] | None, typer.Option(metavar="NAME", help="A part, such as table3, fig7 or fit.")] = None,
    out: Annotated[Path, typer.Option(help="Folder for the report and the runs it is made of.")] = Path("out/paper"),
) -> None:
    """Rerun the paper's study and write a report: tables, figures and claims."""
    from drake_formation.paper.reproduce import reproduce as run_study
    from drake_formation.simulation import SimulationError

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed} / {task.total} runs"))
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("study", total=None)
        try:
            run_study(out, only or (), lambda done, total: progress.update(task, completed=done, total=total))
        except ValueError as error:
            _stop(str(error), WRONG_INPUT)
        except SimulationError as error:
            _stop(str(error), FAILED_RUN)
    console.print(f"Report in {out / 'report.html'}, tables in {out / 'tables.csv'}.", soft_wrap=True)


@app.command()
def schema() -> None:
    """Print the JSON Schema of a scenario, for editors."""
    print(json.dumps(json_schema(), indent=2, ensure_ascii=False))


@app.command()
def scenarios() -> None:
    """List the scenarios that come with the package."""
    table = Table("name", "robots", "what it shows")
    for name in shipped_scenarios():
        scenario = load_scenario(name)
        table.add_row(name, str(derive.robot_count(scenario.formation)), scenario.description)
    console.print(table)


def _simulate_with_progress(scenario: Scenario, engine: EngineName) -> "xr.Dataset":
    from drake_formation.simulation import simulate, simulated_duration

    total = simulated_duration(scenario)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.1f} / {task.total:.0f} s simulated"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(scenario.name, total=total)
        return simulate(scenario, engine=engine.value, progress=lambda time: progress.update(task, completed=time))


def _summary(scenario: Scenario, figures: dict[str, Any]) -> Table:
    labels = {
        "tracking_error_m": ("largest tracking error, by robot", "m"),
        "consensus_error_m": ("largest consensus error", "m"),
        "peak_force_n": ("peak control force", "N"),
        "min_clearance_m": ("least distance to an obstacle", "m"),
        "max_spring_strain": ("largest spring strain", "1"),
        "settling_time_s": ("settled within 2 % after", "s"),
    }
    table = Table("metric", "value", "unit", title=f"{scenario.name}, transport")
    for name, (label, unit) in labels.items():
        table.add_row(label, _number(figures[name]), unit)
    return table


def _number(value: float | list[float] | None) -> str:
    if value is None:
        return "none"
    return ", ".join(f"{number:.4g}" for number in value) if isinstance(value, list) else f"{value:.4g}"


def _description(scenario: Scenario) -> Table:
    """What a scenario reads as."""
    count = derive.robot_count(scenario.formation)
    table = Table("part", "reads as", title=scenario.name)
    table.add_row("formation", f"{scenario.formation.shape} of {count}")
    for name, graph in (
        ("springs", derive.spring_graph(scenario)),
        ("consensus", derive.communication_graph(scenario)),
    ):
        edges = " ".join(f"{i + 1}-{j + 1}" for i, j in graphs.edges(graph)) or "none"
        table.add_row(f"{name} edges", edges)
        table.add_row(f"{name} algebraic connectivity", f"{graphs.algebraic_connectivity(graph):.4g}")
    springs, consensus = scenario.springs, scenario.consensus
    table.add_row(
        "springs", f"{springs.law}, k = {_values(springs.stiffness)} N/m, c = {_values(springs.damping)} N s/m"
    )
    table.add_row("consensus", f"δ = {consensus.delta:g} N/m, δ_v = {consensus.delta_v:g} N s/m")
    table.add_row("channels", str(graphs.channels(derive.communication_graph(scenario))))
    table.add_row("masses", f"{_values(scenario.robots.mass)} kg")
    return table


def _values(value: float | tuple[float, ...]) -> str:
    return ", ".join(f"{number:g}" for number in value) if isinstance(value, tuple) else f"{value:g}"


def _stop(message: str, status: int) -> NoReturn:
    """Say what is wrong, as plain text on standard error, and leave."""
    print(message, file=sys.stderr)
    raise SystemExit(status)
