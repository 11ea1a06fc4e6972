"""A bar on standard error that moves as runs are finished."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def runs_bar(name: str) -> Iterator[Callable[[int, int], None]]:
    """A progress bar; gives what to call with the runs that are done and all there are."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn  # slow to import

    from drake_formation.terminal.tables import progress_console

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed} / {task.total} runs"))
    with Progress(*columns, TimeRemainingColumn(), console=progress_console(), transient=True) as progress:
        task = progress.add_task(name, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
