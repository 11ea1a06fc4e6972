"""A part of the study: which runs it needs, and the section of the report that it makes of them."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from drake_formation.paper.store import Store
from drake_formation.paper.tables import Cell
from drake_formation.scenario import Scenario
from drake_formation.viz.style import draw

Picture = Callable[[Path], None]
"""Draws itself to a file, as its suffix says."""
Runs = Callable[[], list[Scenario]]


@dataclass(frozen=True, kw_only=True)
class Section:
    """A piece of the report.

    Attributes:
        title: its heading.
        text: Markdown under the heading.
        pictures: by file name without suffix.
        cells: rows for ``tables.csv``.
    """

    title: str
    text: str = ""
    pictures: dict[str, Picture] = field(default_factory=dict)
    cells: list[Cell] = field(default_factory=list)


def no_runs() -> list[Scenario]:
    """What a part needs that is about no runs."""
    return []


@dataclass(frozen=True, kw_only=True)
class Part:
    """A part of the study.

    Attributes:
        make: the section, from the store.
        runs: the scenarios whose results it needs, known beforehand.
        measured: those of which it needs the figures alone.
    """

    make: Callable[[Store], Section]
    runs: Runs = no_runs
    measured: Runs = no_runs


def picture(make: Callable[[Store], Figure], store: Store) -> Picture:
    """A figure that is drawn when it is written."""
    return partial(_save, partial(make, store))


def figure(
    name: str,
    title: str,
    make: Callable[[Store], Figure],
    *,
    text: str = "",
    runs: Runs = no_runs,
    measured: Runs = no_runs,
) -> Part:
    """A part that is one figure.

    Args:
        name: of its file.
        title: heading.
        make: draws it.
        text: what there is to say under the heading.
        runs: see :class:`Part`.
        measured: likewise.
    """
    return Part(
        make=lambda store: Section(title=title, text=text, pictures={name: picture(make, store)}),
        runs=runs,
        measured=measured,
    )


def _save(make: Callable[[], Figure], path: Path) -> None:
    draw(make, path)
