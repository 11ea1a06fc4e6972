"""The folder that a run leaves behind."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import xarray as xr

from drake_formation.diagram import build_diagram
from drake_formation.metrics import Metrics
from drake_formation.places import Kind, Place
from drake_formation.scenario import Scenario, to_yaml
from drake_formation.simulation.check import Check
from drake_formation.viz.graphviz import write_diagram
from drake_formation.viz.style import attempt_each

RESULT, SCENARIO, METRICS, FAILURE = "result.nc", "scenario.yaml", "metrics.json", "failure.txt"
PICTURES, DIAGRAMS = "figures", ("diagram.dot", "diagram.svg")

RUN = Kind(RESULT, (METRICS, SCENARIO, PICTURES, *DIAGRAMS, RESULT))
FAILED_RUN = Kind(FAILURE, (SCENARIO, RESULT, PICTURES, FAILURE))


@dataclass(frozen=True)
class Written:
    """What was written.

    Attributes:
        folder: where.
        failed: pictures that are missing, by name, and why.
        notes: why it is somewhere else than asked for, if it is.
    """

    folder: Path
    failed: dict[str, str]
    notes: list[str]

    def remarks(self) -> list[str]:
        """What the user should know, line by line."""
        pictures = [f"No figure {name}: {reason.removesuffix('.')}." for name, reason in self.failed.items()]
        return [*pictures, *self.notes]


def write_run(place: Place, scenario: Scenario, result: xr.Dataset, figures: Metrics) -> Written:
    """Write a complete run: metrics, resolved scenario and result first, then diagram and figures.

    Args:
        place: where.
        scenario: as resolved; running it again repeats the run.
        result: what came out.
        figures: its metrics.

    Raises:
        OutputError: it cannot be written anywhere.
    """

    def write(folder: Path) -> dict[str, str]:
        (folder / METRICS).write_text(json.dumps(figures.to_dict(), indent=2) + "\n", encoding="utf-8")
        _write_recorded(folder, scenario, result)
        draw = {name: partial(_draw_diagram, scenario, folder / name) for name in DIAGRAMS}
        return attempt_each(draw) | _draw_figures(folder, result)

    return written(place, write)


def write_check(folder: Path, check: Check) -> None:
    """Add what a check says to the metrics of a run that is written, under the key ``check``."""
    figures = json.loads((folder / METRICS).read_text(encoding="utf-8"))
    partial = folder / f".{METRICS}"
    partial.write_text(json.dumps(figures | {"check": check.to_dict()}, indent=2) + "\n", encoding="utf-8")
    partial.replace(folder / METRICS)


def write_failed_run(place: Place, scenario: Scenario, partial_result: xr.Dataset, reason: str) -> Written:
    """Write what a failed run recorded, beside the place where its result would have gone.

    The folder is named after the one wanted: ``line.failed`` for ``line``.

    Raises:
        OutputError: it cannot be written anywhere.
    """

    def write(folder: Path) -> dict[str, str]:
        (folder / FAILURE).write_text(reason + "\n", encoding="utf-8")
        _write_recorded(folder, scenario, partial_result)
        return _draw_figures(folder, partial_result)

    return written(place, write, lambda: place.take_beside(".failed", FAILED_RUN))


def written(place: Place, write: Callable[[Path], dict[str, str]], take: Callable[[], Path] | None = None) -> Written:
    """Fill a place and take it.

    Args:
        place: where.
        write: writes the files to a folder; gives the pictures that failed, and why.
        take: takes the place, if not as usual.
    """
    failed = place.fill(write)
    folder = (take or place.take)()
    return Written(folder, failed, place.notes)


def _write_recorded(folder: Path, scenario: Scenario, result: xr.Dataset) -> None:
    (folder / SCENARIO).write_text(to_yaml(scenario), encoding="utf-8")
    compressed = {name: {"zlib": True} for name, variable in result.data_vars.items() if "time" in variable.dims}
    try:
        result.to_netcdf(folder / RESULT, engine="netcdf4", encoding=compressed)
    except RuntimeError as error:  # what the NetCDF library says when the disk is full
        raise OSError(f"{RESULT}: {error}") from error


def _draw_figures(folder: Path, result: xr.Dataset) -> dict[str, str]:
    (folder / PICTURES).mkdir()
    failed: dict[str, str] = {}

    def draw() -> None:
        from drake_formation.viz.figures import write_figures  # Matplotlib itself may be out of order

        failed.update(write_figures(result, folder / PICTURES))

    return attempt_each({PICTURES: draw}) | failed


def _draw_diagram(scenario: Scenario, path: Path) -> None:
    write_diagram(build_diagram(scenario), path)
