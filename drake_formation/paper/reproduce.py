"""Rerun the study, or parts of it, and write the report."""

from collections.abc import Callable, Sequence
from pathlib import Path

from drake_formation.config.errors import nearest
from drake_formation.paper.report import REPORT, RUNS, write_report
from drake_formation.paper.section import Part
from drake_formation.paper.store import Store
from drake_formation.paper.study import PARTS
from drake_formation.places import Written, make_folder, reserved, written

Progress = Callable[[int, int], None]
"""Called with how many of the missing runs are done, and how many there are."""


def reproduce(
    folder: Path, only: Sequence[str] = (), progress: Progress | None = None, file_format: str = "png"
) -> Written:
    """Make every run that is missing in a folder, and write the report of the named parts there.

    Args:
        folder: for the report and, in ``runs``, the results; made if missing.
        only: names of parts; all if empty.
        progress: called before the first run and after each.
        file_format: of figures beside the PNGs that the report shows, if another.

    Returns:
        Where the report is, and the pictures it is without.

    Raises:
        ValueError: a part is unknown.
        OutputError: the folder cannot be used, or holds something else than an earlier study.
    """
    for name in only:
        if name not in PARTS:
            raise ValueError(f"no part {name!r} of the study{_hint(name)}; there are {', '.join(PARTS)}")
    parts = [part for name, part in PARTS.items() if not only or name in only]
    make_folder(folder, REPORT)
    store = Store(folder / RUNS)  # kept whatever happens to the report
    with reserved(folder, REPORT) as place:
        _run(store, parts, progress)
        sections = [part.make(store) for part in parts]
        return written(place, lambda partial: write_report(partial, sections, file_format))


def _run(store: Store, parts: Sequence[Part], progress: Progress | None) -> None:
    results = [scenario for part in parts for scenario in part.runs()]
    missing = store.missing(results, [scenario for part in parts for scenario in part.measured()])
    total, done = len(missing), 0

    def count() -> None:
        nonlocal done
        done += 1
        if progress:
            progress(done, total)

    if progress:
        progress(0, total)
    store.run(missing, count)


def _hint(name: str) -> str:
    near = nearest(name, PARTS)
    return f", did you mean {near!r}?" if near else ""
