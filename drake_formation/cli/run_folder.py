"""The folder that a run leaves behind."""

import json
from functools import partial
from pathlib import Path

import xarray as xr

from drake_formation.diagram import build_diagram
from drake_formation.measuring import Metrics
from drake_formation.measuring.check import Check
from drake_formation.places import PICTURES, Kind, Place, Written, written
from drake_formation.results import RESULT
from drake_formation.scenario import Scenario, dump_scenario
from drake_formation.simulation.events import events
from drake_formation.viz.graphviz import write_diagram
from drake_formation.viz.style import attempt_each

SCENARIO, METRICS, FAILURE = "scenario.yaml", "metrics.json", "failure.txt"
EVENTS = "events"
"""The key of what happened, beside the metrics."""
DIAGRAMS = ("diagram.dot", "diagram.svg")

RUN = Kind(RESULT, (METRICS, SCENARIO, PICTURES, *DIAGRAMS, RESULT))
FAILED_RUN = Kind(FAILURE, (SCENARIO, RESULT, PICTURES, FAILURE))


def write_run(
    place: Place, scenario: Scenario, result: xr.Dataset, figures: Metrics, file_format: str = "png"
) -> Written:
    """Write a complete run: metrics, resolved scenario and result first, then diagram and figures.

    Args:
        place: where.
        scenario: as resolved; running it again repeats the run.
        result: what came out.
        figures: its metrics.
        file_format: of the figures, png, pdf or svg.

    Raises:
        OutputError: it cannot be written anywhere.
    """

    def write(folder: Path) -> dict[str, str]:
        measured = figures.to_dict() | {EVENTS: [event.to_dict() for event in events(result)]}
        (folder / METRICS).write_text(json.dumps(measured, indent=2) + "\n", encoding="utf-8")
        _write_recorded(folder, scenario, result)
        draw = {name: partial(_draw_diagram, scenario, folder / name) for name in DIAGRAMS}
        return attempt_each(draw) | _draw_figures(folder, result, file_format)

    return written(place, write)


def write_check(folder: Path, check: Check) -> None:
    """Add what a check says to the metrics of a run that is written, under the key ``check``."""
    figures = json.loads((folder / METRICS).read_text(encoding="utf-8"))
    partial = folder / f".{METRICS}"
    partial.write_text(json.dumps(figures | {"check": check.to_dict()}, indent=2) + "\n", encoding="utf-8")
    partial.replace(folder / METRICS)


def write_failed_run(
    place: Place, scenario: Scenario, partial_result: xr.Dataset, reason: str, file_format: str = "png"
) -> Written:
    """Write what a failed run recorded, beside the place where its result would have gone.

    The folder is named after the one wanted: ``line.failed`` for ``line``.

    Raises:
        OutputError: it cannot be written anywhere.
    """

    def write(folder: Path) -> dict[str, str]:
        (folder / FAILURE).write_text(reason + "\n", encoding="utf-8")
        _write_recorded(folder, scenario, partial_result)
        return _draw_figures(folder, partial_result, file_format)

    return written(place, write, lambda: place.take_beside(".failed", FAILED_RUN))


def _write_recorded(folder: Path, scenario: Scenario, result: xr.Dataset) -> None:
    dump_scenario(scenario, folder / SCENARIO)
    compressed = {name: {"zlib": True} for name, variable in result.data_vars.items() if "time" in variable.dims}
    try:
        result.to_netcdf(folder / RESULT, engine="netcdf4", encoding=compressed)
    except RuntimeError as error:  # what the NetCDF library says when the disk is full
        raise OSError(f"{RESULT}: {error}") from error


def _draw_figures(folder: Path, result: xr.Dataset, file_format: str) -> dict[str, str]:
    (folder / PICTURES).mkdir()
    failed: dict[str, str] = {}

    def draw() -> None:
        from drake_formation.viz.figures import write_figures  # Matplotlib itself may be out of order

        failed.update(write_figures(result, folder / PICTURES, file_format))

    return attempt_each({PICTURES: draw}) | failed


def _draw_diagram(scenario: Scenario, path: Path) -> None:
    write_diagram(build_diagram(scenario), path)
