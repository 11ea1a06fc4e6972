"""The folder a run leaves behind: written beside its place, and moved there when complete."""

import json
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import xarray as xr

from drake_formation.check import Check
from drake_formation.diagram import build_diagram
from drake_formation.metrics import Metrics
from drake_formation.scenario import Scenario, to_yaml
from drake_formation.viz.figures import write_figures
from drake_formation.viz.graphviz import write_diagram

RESULT, SCENARIO, METRICS, FAILURE = "result.nc", "scenario.yaml", "metrics.json", "failure.txt"


class OutputError(OSError):
    """A place where a run cannot be written."""


def require_place(folder: Path, *, mark: str = RESULT) -> None:
    """Make sure that a result may be written to a folder.

    Args:
        folder: where.
        mark: the file by which an earlier result of the same sort, which may be replaced, is known.

    Raises:
        OutputError: it is a file, cannot be made, or holds something else than such a result, which would be lost.
    """
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder}: is a file; give a folder that is new, empty or holds an earlier {mark}")
    if folder.is_dir() and any(folder.iterdir()) and not (folder / mark).exists():
        raise OutputError(f"{folder}: holds something else than a {mark}, which would be lost; give another folder")
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent):
            pass
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written: {error.strerror}") from error


def write_run(folder: Path, scenario: Scenario, result: xr.Dataset, figures: Metrics) -> None:
    """Write a complete run: metrics, result, resolved scenario, diagram and figures.

    Args:
        folder: where; an earlier run there is replaced as a whole.
        scenario: as resolved; running it again repeats the run.
        result: what came out.
        figures: its metrics.
    """
    with moved_into_place(folder) as partial:
        (partial / METRICS).write_text(json.dumps(figures.to_dict(), indent=2) + "\n", encoding="utf-8")
        _write_recorded(partial, scenario, result)
        diagram = build_diagram(scenario)
        for suffix in (".dot", ".svg"):
            write_diagram(diagram, partial / f"diagram{suffix}")


def write_check(folder: Path, check: Check) -> None:
    """Add what a check says to the metrics of a run that is written, under the key ``check``."""
    figures = json.loads((folder / METRICS).read_text(encoding="utf-8"))
    partial = folder / f".{METRICS}"
    partial.write_text(json.dumps(figures | {"check": check.to_dict()}, indent=2) + "\n", encoding="utf-8")
    partial.replace(folder / METRICS)


def write_failed_run(folder: Path, scenario: Scenario, partial_result: xr.Dataset, reason: str) -> Path:
    """Write what a failed run recorded, beside the folder its result would have gone to.

    Returns:
        The folder, named after the one wanted: ``line.failed`` for ``line``.
    """
    failed = folder.with_name(f"{folder.name}.failed")
    with moved_into_place(failed) as partial:
        (partial / FAILURE).write_text(reason + "\n", encoding="utf-8")
        _write_recorded(partial, scenario, partial_result)
    return failed


def _write_recorded(folder: Path, scenario: Scenario, result: xr.Dataset) -> None:
    (folder / SCENARIO).write_text(to_yaml(scenario), encoding="utf-8")
    compressed = {name: {"zlib": True} for name, variable in result.data_vars.items() if "time" in variable.dims}
    result.to_netcdf(folder / RESULT, engine="netcdf4", encoding=compressed)
    (folder / "figures").mkdir()
    write_figures(result, folder / "figures")


@contextmanager
def moved_into_place(folder: Path, *, mark: str = RESULT) -> Iterator[Path]:
    """A new folder that takes the given one's place if all goes well, and is removed if not.

    Args:
        folder: where.
        mark: as for :func:`require_place`.

    Raises:
        OutputError: as for :func:`require_place`.
    """
    require_place(folder, mark=mark)
    partial = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
    try:
        yield partial
        partial.chmod(0o755)
        if folder.exists():
            former = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
            folder.rename(former / "run")
            partial.rename(folder)
            shutil.rmtree(former)
        else:
            partial.rename(folder)
    finally:
        shutil.rmtree(partial, ignore_errors=True)
