"""The command line: ``drake-formation run | sweep | analyze | validate | graphviz | reproduce | schema | …``."""

import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from drake_formation.formation import graphs
from drake_formation.scenario import (
    Scenario,
    ScenarioError,
    json_schema,
    load_scenario,
    resolve,
    shipped_scenarios,
)
from drake_formation.terminal import FAILED_RUN, INTERRUPTED, WRONG_INPUT, Stopped, orderly, say, stop

if TYPE_CHECKING:
    import xarray as xr

    from drake_formation.simulation.check import Check

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


def _path(text: str) -> Path:
    """A path as given; an empty one is a slip (a variable without a value, say) and not the current folder."""
    if not text:
        raise typer.BadParameter("an empty name")
    return Path(text)


class EngineName(StrEnum):
    """What carries a run out."""

    AUTO = "auto"
    BLOCKS = "blocks"
    COMPILED = "compiled"
    EXPONENTIAL = "exponential"


class SweepEngineName(StrEnum):
    """What carries the runs of a sweep out; over many runs, compiling pays."""

    BLOCKS = "blocks"
    COMPILED = "compiled"
    EXPONENTIAL = "exponential"


ENGINES_HELP = "The block diagram itself, or code compiled from it, integrated by steps or exponentially"


class ExecutorName(StrEnum):
    """Who carries out the runs of a sweep."""

    SERIAL = "serial"
    PROCESSES = "processes"


def main() -> None:
    """Entry point of the command; turns what a user can do wrong into a message and an exit status."""
    # Figures are files in this project's style: neither a window nor a user's settings of Matplotlib are asked for.
    os.environ |= {"MPLBACKEND": "agg", "MATPLOTLIBRC": os.devnull}
    try:
        with orderly():
            app()
    except ScenarioError as error:
        stop(str(error), WRONG_INPUT)


@app.command()
def run(
    scenario: Source,
    overrides: Overrides = None,
    out: Annotated[
        Path | None, typer.Option(parser=_path, metavar="FOLDER", help="For the results; out/NAME if not given.")
    ] = None,
    engine: Annotated[
        EngineName, typer.Option(help=f"{ENGINES_HELP}; auto: blocks or compiled, whichever is done first.")
    ] = EngineName.AUTO,
    check: Annotated[bool, typer.Option("--check", help="Run it again, more accurately, and compare.")] = False,
) -> None:
    """Run a scenario and write its metrics, result, diagram and figures."""
    from drake_formation.lowering.errors import LoweringError
    from drake_formation.metrics import metrics
    from drake_formation.output import PICTURES, RUN, write_check, write_failed_run, write_run
    from drake_formation.places import OutputError, reserved
    from drake_formation.simulation import SimulationError

    resolved = load_scenario(scenario, overrides=overrides)
    try:
        with reserved(out or Path("out") / resolved.name, RUN) as place:
            try:
                result = _simulate_with_progress(resolved, engine)
                figures = metrics(result)
            except SimulationError as error:
                kept = write_failed_run(place, resolved, error.partial, str(error))
                recorded = f"What was recorded until then is in {kept.folder}."
                stop("\n".join([str(error), *kept.remarks(), recorded]), FAILED_RUN)
            written = write_run(place, resolved, result, figures)
        checked = _check_with_progress(resolved, result) if check else None
        if checked:
            write_check(written.folder, checked)
    except (OutputError, LoweringError) as error:
        stop(str(error), WRONG_INPUT)
    say(_summary(result, figures.to_dict(), checked))
    remark = [str(result.attrs["remark"])] if "remark" in result.attrs else []
    where = f"Results in {written.folder}, pictures in {written.folder / PICTURES}."
    say("\n".join([*remark, *written.remarks(), where]))


@app.command()
def sweep(
    source: Annotated[str, typer.Argument(metavar="SWEEP", help="A sweep file, or the name of a shipped one.")],
    out: Annotated[
        Path, typer.Option(parser=_path, metavar="FOLDER", help="For the runs, the dataset and its figures.")
    ],
    engine: Annotated[SweepEngineName, typer.Option(help=f"{ENGINES_HELP}.")] = SweepEngineName.COMPILED,
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
        stop(str(error), WRONG_INPUT)
    except SweepStoppedError as error:
        stop(f"{error}\n{kept_message(out)}", FAILED_RUN)
    except KeyboardInterrupt:
        stop(f"interrupted\n{kept_message(out)}", INTERRUPTED)
    except Stopped as reason:
        stop(f"{reason.message}\n{kept_message(out)}", reason.status)
    with results:
        message, failed = closing(results, out)
        say(summary(results))
    say(message)
    if failed:
        raise SystemExit(FAILED_RUN)


@app.command()
def analyze(
    scenario: Source,
    overrides: Overrides = None,
    out: Annotated[
        Path | None,
        typer.Option(parser=_path, metavar="FOLDER", help="For the certificate and its figures, if wanted."),
    ] = None,
    period: Annotated[float | None, typer.Option(help="Sampling period of the loss margin (s).")] = None,
    damping_ratio: Annotated[float | None, typer.Option(help="Find the smallest δ with this damping ratio.")] = None,
    decay_rate: Annotated[float | None, typer.Option(help="Find the smallest δ with this decay rate (1/s).")] = None,
    force_limit: Annotated[float | None, typer.Option(help="Find the largest δ under this force (N).")] = None,
    topology: Annotated[float | None, typer.Option(help="Find the fewest channels for this error (m).")] = None,
) -> None:
    """Certify a scenario before it is simulated: stability, modes, margins and what disturbances do."""
    from drake_formation.analysis import IllPosedError, Questions, certify
    from drake_formation.analysis.report import report
    from drake_formation.analysis_output import CERTIFICATE, write_certificate
    from drake_formation.output import PICTURES
    from drake_formation.places import OutputError, reserved

    resolved = load_scenario(scenario, overrides=overrides)
    try:
        asked = Questions(period, damping_ratio, decay_rate, force_limit, topology)
        with (
            reserved(out, CERTIFICATE) if out else nullcontext() as place,
            Console(stderr=True).status("linearizing", spinner="line") as status,
        ):
            certificate = certify(resolved, questions=asked, progress=lambda part: status.update(f"analyzing: {part}"))
            written = place and write_certificate(place, certificate)
    except (OutputError, IllPosedError) as error:
        stop(str(error), WRONG_INPUT)
    say(report(certificate))
    if written:
        where = f"Certificate in {written.folder}, figures in {written.folder / PICTURES}."
        say("\n".join([*written.remarks(), where]))


@app.command()
def validate(scenario: Source, overrides: Overrides = None) -> None:
    """Check a scenario and say what it reads as."""
    say(_description(load_scenario(scenario, overrides=overrides)))


@app.command()
def graphviz(
    scenario: Source,
    output: Annotated[
        Path,
        typer.Option("--output", "-o", parser=_path, metavar="FILE", help="Ends in .dot, .svg, .png or .pdf."),
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


@app.command()
def reproduce(
    only: Annotated[list[str] | None, typer.Option(metavar="NAME", help="A part, such as table3, fig7 or fit.")] = None,
    out: Annotated[
        Path, typer.Option(parser=_path, metavar="FOLDER", help="For the report and the runs it is made of.")
    ] = Path("out/paper"),
) -> None:
    """Rerun the paper's study and write a report: tables, figures and claims."""
    from drake_formation.paper.reproduce import reproduce as run_study
    from drake_formation.places import OutputError
    from drake_formation.simulation import SimulationError
    from drake_formation.sweep import SweepStoppedError

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed} / {task.total} runs"))
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("study", total=None)
        try:
            written = run_study(out, only or (), lambda done, total: progress.update(task, completed=done, total=total))
        except (OutputError, ValueError) as error:
            stop(str(error), WRONG_INPUT)
        except (SimulationError, SweepStoppedError) as error:
            stop(str(error), FAILED_RUN)
    where = f"Report in {written.folder / 'report.html'}, tables in {written.folder / 'tables.csv'}."
    say("\n".join([*written.remarks(), where]))


@app.command()
def schema() -> None:
    """Print the JSON Schema of a scenario, for editors."""
    say(json.dumps(json_schema(), indent=2, ensure_ascii=False))


@app.command()
def scenarios() -> None:
    """List the scenarios that come with the package."""
    table = Table("name", "robots", "what it shows")
    for name in shipped_scenarios():
        scenario = load_scenario(name)
        table.add_row(name, str(resolve(scenario).robots), scenario.description)
    say(table)


@app.command()
def parts() -> None:
    """List the parts that the boxes of the diagram may be, and which package brings each."""
    from drake_formation.parts.registry import broken, kinds
    from drake_formation.parts.roles import ROLES

    table = Table("role", "section", "kind", "what it is", "from")
    for name, role in ROLES.items():
        section = ".".join(map(str, role.section))
        for kind, part in kinds(name).items():
            meaning = (part.__doc__ or "").splitlines()[0] if part.__doc__ else ""
            table.add_row(name, f"{section}, {role.chooser}", kind, meaning, part.distribution)
    say(table)
    for reason in dict.fromkeys(reason for name in ROLES for reason in broken(name).values()):
        say(reason)


def _simulate_with_progress(scenario: Scenario, engine: EngineName) -> "xr.Dataset":
    from drake_formation.simulation import simulate

    with _progress(scenario, scenario.name) as progress:
        return simulate(scenario, engine=engine.value, progress=progress)


def _check_with_progress(scenario: Scenario, result: "xr.Dataset") -> "Check":
    from drake_formation.simulation import SimulationError
    from drake_formation.simulation.check import check

    try:
        with _progress(scenario, f"check of {scenario.name}") as progress:
            return check(scenario, result, progress=progress)
    except SimulationError as error:
        stop(f"The run is complete, but its check is not: {error}", FAILED_RUN)


@contextmanager
def _progress(scenario: Scenario, name: str) -> Iterator[Callable[[float], None]]:
    """A bar on standard error that goes on with the simulated time."""
    from drake_formation.simulation import simulated_duration

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.1f} / {task.total:.0f} s simulated"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(name, total=simulated_duration(scenario))
        yield lambda time: progress.update(task, completed=time)


def _summary(result: "xr.Dataset", figures: dict[str, Any], check: "Check | None") -> Table:
    labels = {
        "tracking_error_m": ("largest tracking error, by robot", "m"),
        "consensus_error_m": ("largest consensus error", "m"),
        "peak_force_n": ("peak control force", "N"),
        "min_clearance_m": ("least distance to an obstacle", "m"),
        "max_spring_strain": ("largest spring strain", "1"),
        "settling_time_s": ("settled within 2 % after", "s"),
    }
    reason = result.attrs.get("engine_reason", "as asked for")
    caption = escape(f"engine {result.attrs['engine']}: {reason}")
    columns = ("metric", "value", "unit") + (("check differs by",) if check else ())
    table = Table(*columns, title=f"{result.attrs['title']}, transport", caption=caption)
    for name, (label, unit) in labels.items():
        table.add_row(label, _number(figures[name]), unit, *([_number(check.metrics[name])] if check else []))
    if check:
        table.add_row("positions at any time", "", "m", _number(check.position_difference_m))
    return table


def _number(value: float | list[float] | None) -> str:
    if value is None:
        return "none"
    return ", ".join(f"{number:.4g}" for number in value) if isinstance(value, list) else f"{value:.4g}"


def _description(scenario: Scenario) -> Table:
    """What a scenario reads as."""
    from drake_formation.config.errors import shown
    from drake_formation.parts.roles import ROLES
    from drake_formation.scenario.owned import section

    formation = resolve(scenario)
    table = Table("part", "reads as", title=scenario.name)
    table.add_row("formation", f"{scenario.formation.shape} of {formation.robots}")
    for name, graph in (("springs", formation.springs.graph), ("consensus", formation.channels.graph)):
        edges = " ".join(f"{i + 1}-{j + 1}" for i, j in graphs.edges(graph)) or "none"
        table.add_row(f"{name} edges", edges)
        table.add_row(f"{name} algebraic connectivity", f"{graphs.algebraic_connectivity(graph):.4g}")
    table.add_row("channels", str(len(formation.channels.pairs)))
    for name, role in ROLES.items():
        written = section(scenario, name)
        classes: list[Any] = sorted({type(part) for part in formation.parts[name]}, key=lambda cls: str(cls.kind))
        fields = {key: its for cls in classes for key, its in cls.Config.model_fields.items()}
        given = [_reads(key, its.description or "", getattr(written, key)) for key, its in fields.items()]
        kind = shown(getattr(written, role.chooser))
        table.add_row(".".join(map(str, role.section)), ": ".join(filter(None, [kind, ", ".join(given)])))
    return table


def _reads(name: str, description: str, value: Any) -> str:
    """A field with its value, its symbol and its unit, as far as its description has them."""
    from drake_formation.config.errors import shown

    label, _, rest = description.partition(" (")
    unit, closed, _ = rest.partition(")")
    text = f"{value:g}" if isinstance(value, float) else shown(value)
    return f"{label} = {text} {unit}" if closed and len(label) < 40 else f"{name} = {text}"
