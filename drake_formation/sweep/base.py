"""The base scenario of a file of many runs, with the file's own values set in it."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from drake_formation.config.errors import Fault, ScenarioError, nearest, shown
from drake_formation.scenario import shipped_scenarios
from drake_formation.scenario.overrides import apply, plain
from drake_formation.scenario.source import Document, read
from drake_formation.sweep.limits import value_faults


def mapped_document(name: str, source: Mapping[str, Any]) -> Document:
    """What stands in a mapping from Python, in place of a file of many runs.

    Args:
        name: what faults call it.
        source: it may hold anything, scenarios too.

    Raises:
        ScenarioError: it is not plain data.
    """
    document = Document(name, {})
    try:
        data = plain(source)
        json.dumps(data, default=str)  # checks the keys, and that nothing contains itself
    except (RecursionError, TypeError, ValueError) as error:
        raise document.attributed([Fault((), f"not plain data: {error}")]) from error
    return replace(document, data=data)


def base_document(
    document: Document, scenario: str | dict[str, Any], values: Mapping[str, Any], folder: Path
) -> Document:
    """The base scenario with values set in it, said to stand where the file says them.

    Args:
        document: the file.
        scenario: its key ``scenario``: a file relative to the folder, the name of a shipped scenario, or a scenario.
        values: its key ``set``: by dotted path.
        folder: of the file.

    Raises:
        ScenarioError: there is no such scenario, or a value cannot be set.
    """
    base = _scenario_document(document, scenario, folder)
    if faults := list(value_faults(base.data)):
        raise base.attributed(faults)
    return with_values(base, values, {path: document.origin(("set", path)) for path in values})


def with_values(base: Document, values: Mapping[str, Any], origins: Mapping[str, str]) -> Document:
    """A document with values set in it by dotted path, each of a known origin.

    Raises:
        ScenarioError: a value cannot be set.
    """
    try:
        changed = apply(base, values)
    except ScenarioError as error:
        raise ScenarioError(placed(error.faults, origins)) from None
    names = {f"overrides[{path!r}]": origin for path, origin in origins.items()}
    return replace(changed, origins={place: names.get(origin, origin) for place, origin in changed.origins.items()})


def placed(faults: Iterable[Fault], origins: Mapping[str, str]) -> list[Fault]:
    """Faults of overrides, said to stand where a file says their values."""
    places = {f"overrides[{path!r}]": origin for path, origin in origins.items()}
    return [replace(fault, origin=places.get(fault.origin, fault.origin)) for fault in faults]


def _scenario_document(document: Document, scenario: str | dict[str, Any], folder: Path) -> Document:
    if isinstance(scenario, dict):
        length = len(place := ("scenario",))
        origins = {path[length:]: origin for path, origin in document.origins.items() if path[:length] == place}
        return Document(document.name, scenario, origins)
    shipped = shipped_scenarios()
    path = folder / scenario
    try:
        exists = path.is_file()
    except (OSError, ValueError) as error:
        reason = (isinstance(error, OSError) and error.strerror) or str(error)
        fault = Fault(("scenario",), f"not a usable path: {reason}", shown(scenario))
        raise document.attributed([fault]) from error
    if exists:
        return read(path)
    if scenario in shipped:
        return read(shipped[scenario])
    allowed = f"a file (relative to {folder.resolve()}), {', '.join(shipped)}"
    fault = Fault(
        ("scenario",), "no such file or shipped scenario", shown(scenario), allowed, nearest(scenario, shipped)
    )
    raise document.attributed([fault])
