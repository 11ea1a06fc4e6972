"""Runs of one scenario with a bar that shows how far they are."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from drake_formation.cli.options import EngineName

if TYPE_CHECKING:
    import xarray as xr

    from drake_formation.scenario import Scenario


def simulate_with_progress(scenario: "Scenario", engine: EngineName = EngineName.AUTO) -> "xr.Dataset":
    """Simulate a scenario; see :func:`drake_formation.simulate`."""
    from drake_formation.simulation import simulate

    with progress_bar(scenario, scenario.name) as progress:
        return simulate(scenario, engine=engine.value, progress=progress)


@contextmanager
def progress_bar(scenario: "Scenario", name: str) -> Iterator[Callable[[float], None]]:
    """A bar on standard error that goes on with the simulated time."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    from drake_formation.simulation import simulated_duration
    from drake_formation.terminal.tables import progress_console

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:.1f} / {task.total:.0f} s simulated"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=progress_console(), transient=True) as progress:
        task = progress.add_task(name, total=simulated_duration(scenario))
        yield lambda time: progress.update(task, completed=time)
