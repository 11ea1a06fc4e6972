"""Loading sweeps: the shipped ones by name, others from files or mappings; what is wrong is found before any run."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from drake_formation.scenario import Fault, ScenarioError
from drake_formation.scenario.load import find_file
from drake_formation.scenario.overrides import apply
from drake_formation.scenario.source import Document, parse, read_text
from drake_formation.scenario.validate import validate
from drake_formation.shipped import shipped
from drake_formation.sweep.axes import Axis, resolve
from drake_formation.sweep.base import base_document, mapped_document, placed
from drake_formation.sweep.coordinates import name_faults
from drake_formation.sweep.definition import Sweep, probes
from drake_formation.sweep.faults import parsed
from drake_formation.sweep.limits import series_faults, size_faults, value_faults
from drake_formation.sweep.schema import SECTIONS, SweepFile


def load_sweep(source: str | Path | Mapping[str, Any]) -> Sweep:
    """Load a sweep.

    Every value that the file writes down, and the ends of every interval, are checked here, each with the first
    values of the other axes. What only a certain combination makes wrong (a graph that names a fifth robot where there
    are four), or a random draw far out, is recorded as that run's failure when its turn comes.

    Args:
        source: a file, the name of a shipped sweep such as ``gains``, or what would stand in a file as a mapping;
            ``scenario`` may then be a Scenario.

    Returns:
        The sweep.

    Raises:
        ScenarioError: with all faults found, each with file and line.
    """
    if isinstance(source, Mapping):
        document, folder, text = mapped_document("the sweep", source), Path(), ""
    else:
        path = find_file(source, shipped_sweeps(), "sweep")
        text, folder = read_text(path), path.parent
        document = parse(text, str(path))
    if faults := list(value_faults(document.data)):
        raise document.attributed(faults)
    model = parsed(document, SweepFile, SECTIONS)
    if faults := list(size_faults(model.axes)):
        raise document.attributed(faults)
    axes = _axes(document, model)
    base = base_document(document, model.scenario, model.set, folder)
    sweep = Sweep(model.name, model.description, text, base, axes, model.trajectories)
    _check(sweep, document)
    return sweep


def shipped_sweeps() -> dict[str, Path]:
    """Files of the sweeps that come with the package, by name."""
    return shipped("sweep")


def _axes(document: Document, model: SweepFile) -> tuple[Axis, ...]:
    resolved = [resolve(axis, ("axes", k)) for k, axis in enumerate(model.axes)]
    faults = [fault for _, own in resolved for fault in own]
    axes = tuple(axis for axis, _ in resolved if axis)
    if faults := faults or [*_overlaps(axes), *name_faults(axes)]:
        raise document.attributed(faults)
    return axes


def _overlaps(axes: tuple[Axis, ...]) -> Iterator[Fault]:
    """A field that two columns set, or set one within the other: which came last would decide."""
    setters: dict[tuple[str, ...], str] = {}
    around: dict[tuple[str, ...], str] = {}
    for axis in axes:
        for path in axis.columns:
            keys = tuple(path.split("."))
            prefixes = [keys[:length] for length in range(1, len(keys) + 1)]
            others = [setters[prefix] for prefix in prefixes if prefix in setters]
            others += [around[keys]] if keys in around else []
            for other in dict.fromkeys(others):
                yield Fault(axis.place, f"{path} and {other} both set the same field")
            setters[keys] = path
            around |= dict.fromkeys(prefixes, path)


def _check(sweep: Sweep, document: Document) -> None:
    """Refuse wrong values, each once; and wrong combinations if among the points checked there are no others."""
    wrong: dict[str, Fault] = {}
    combinations: dict[str, Fault] = {}
    sound = False
    for index in probes(sweep):
        origins = {
            path: document.origin(axis.origin(position, path))
            for axis, position in zip(sweep.axes, sweep.positions(index), strict=True)
            for path in axis.overrides(position)
        }
        try:
            point = apply(sweep.base, sweep.overrides(index))
        except ScenarioError as error:
            wrong |= {str(fault): fault for fault in placed(error.faults, origins)}
            continue
        try:
            scenario = validate(point)
            sound = True
        except ScenarioError as error:
            # Pydantic is the cause where a single value is wrong; nothing is where the combination is.
            found = combinations if error.__cause__ is None else wrong
            found |= {str(fault): fault for fault in placed(error.faults, origins)}
            continue
        if large := list(series_faults(sweep.trajectories, scenario, len(sweep))):
            raise document.attributed(large)
    if wrong or not sound:
        raise ScenarioError((wrong or combinations).values())
