"""A sweep in the terminal: a bar that moves as runs are on disk, and in the end what came of it."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import xarray as xr
from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, Task, TaskID, TextColumn
from rich.table import Table
from rich.text import Text

from drake_formation.sweep.dataset import DONE, FAILED, FAILURES
from drake_formation.sweep.quantities import metric_names
from drake_formation.sweep.run import DATASET, FIGURES, MISSING, Tally
from drake_formation.sweep.run import Progress as Report
from drake_formation.terminal.tables import table


@contextmanager
def progress_bar(name: str, console: Console) -> Iterator[Report]:
    """A progress bar; gives what to call as runs finish."""
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed} / {task.total} runs"))
    with Progress(*columns, _Rate(), console=console, transient=True, speed_estimate_period=120) as bar:
        task: TaskID | None = None

        def report(tally: Tally) -> None:
            nonlocal task
            if task is None:  # what was finished before is where the bar begins, and no part of the rate
                task = bar.add_task(name, total=tally.total, completed=tally.finished)
            failed = f", {tally.failed} failed" if tally.failed else ""
            bar.update(task, completed=tally.finished, description=f"{name}{failed}")

        yield report


class _Rate(ProgressColumn):
    """Runs a second over the last two minutes, and the time left at that rate."""

    def render(self, task: Task) -> Text:
        if not task.speed or task.remaining is None:
            return Text("")
        return Text(f"{task.speed:.3g} runs/s, {duration(task.remaining / task.speed)} left")


def duration(seconds: float) -> str:
    """A duration as one would say it: ``42 s``, ``3 min 5 s``, ``2 h 7 min``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


def summary(dataset: xr.Dataset) -> Table:
    """Least, middle and largest value of each metric over all runs."""
    title = f"{dataset.attrs['title']}, {_sizes(dataset)}"
    shown = table("metric", "least", "median", "largest", "unit", title=title)
    for name, numbers in _extremes(dataset).items():
        about = dataset[name].attrs
        shown.add_row(about["long_name"], *("none" if x is None else f"{x:.4g}" for x in numbers), about["units"])
    return shown


def told(dataset: xr.Dataset) -> dict[str, Any]:
    """The same as plain data, and how many runs there are."""
    status = dataset["status"]
    extremes = {
        name: dict(zip(("least", "median", "largest"), numbers, strict=True)) | {"unit": dataset[name].attrs["units"]}
        for name, numbers in _extremes(dataset).items()
    }
    return {
        "sweep": dataset.attrs["title"], "sizes": dict(status.sizes), "done": int((status == DONE).sum()),
        "failed": int((status == FAILED).sum()), "metrics": extremes,
    }  # fmt: skip


def _extremes(dataset: xr.Dataset) -> dict[str, tuple[float | None, ...]]:
    """Least, middle and largest value of each metric; None where no run has a value."""
    measured = (name for name in metric_names() if name in dataset)
    values = {name: dataset[name] for name in measured}
    return {
        name: tuple(float(x) for x in (its.min(), its.median(), its.max())) if its.notnull().any() else (None,) * 3
        for name, its in values.items()
    }


def closing(dataset: xr.Dataset, folder: Path) -> tuple[str, int]:
    """What to say at the end, and how many runs failed."""
    failed = int((dataset["status"] == FAILED).sum())
    done = int((dataset["status"] == DONE).sum())
    pictures = f", pictures in {folder / FIGURES}" if any((folder / FIGURES).glob("*.png")) else ""
    lines = [str(dataset.attrs[MISSING])] if MISSING in dataset.attrs else []
    text = "\n".join([*lines, f"{done} runs in {folder / DATASET}{pictures}."])
    if failed:
        text += f"\n{failed} runs failed: why is in {folder / FAILURES}. --retry-failed runs them again."
    return text, failed


def kept_message(folder: Path) -> str:
    """What to say of a sweep that was stopped."""
    return f"Finished runs are kept in {folder}; the same command goes on from there."


def _sizes(dataset: xr.Dataset) -> str:
    return " × ".join(f"{size} {name}" for name, size in dataset["status"].sizes.items())
