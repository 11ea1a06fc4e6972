"""Changing single values of a scenario by their dotted paths, from Python or from the command line."""

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import BaseModel

from drake_formation.config.errors import Fault, Path, ScenarioError, dotted, shortened, shown
from drake_formation.config.values import Section
from drake_formation.scenario.schema import Scenario
from drake_formation.scenario.source import Document, load_yaml

Overrides = Mapping[str, Any] | Sequence[str]
"""Dotted paths to values (``{"springs.stiffness": 3e4}``), or texts ``PATH=VALUE`` with a YAML value."""


@dataclass(frozen=True)
class _Override:
    keys: tuple[str, ...]
    value: Any
    origin: str


def apply(document: Document, overrides: Overrides | None) -> Document:
    """A document with values replaced, in the order given.

    Paths may enter lists by positions from 0, as in ``avoidance.obstacles.0.position``. Sections that the
    document leaves at their defaults are made on the way. Keys are checked later, with the rest of the scenario.

    Args:
        document: left as it is.
        overrides: what to replace.

    Raises:
        ScenarioError: a text without ``=`` or with faulty YAML, a path given twice, or one that leads through
            a scalar or beyond a list.
    """
    faults: list[Fault] = []
    data, origins = plain(document.data), dict(document.origins)
    for override in _parsed(overrides or (), faults):
        try:
            path, made = _set(data, override)
        except ScenarioError as error:
            faults.extend(error.faults)
            continue
        origins = {key: origin for key, origin in origins.items() if key[: len(path)] != path}
        origins.update(dict.fromkeys([*made, path], override.origin))
    if faults:
        raise ScenarioError(faults)
    return Document(document.name, data, origins)


def plain(value: Any) -> Any:
    """A copy of a value as mappings, lists and scalars; NumPy arrays become lists, models what was set in them."""
    if isinstance(value, BaseModel):
        value = value.model_dump(exclude_unset=True)
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key) if type(key) is int else key: plain(item) for key, item in value.items()}  # a robot's number
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def _parsed(overrides: Overrides, faults: list[Fault]) -> list[_Override]:
    """Overrides taken apart; what is wrong with their form is added to the faults."""
    parsed: dict[str, _Override] = {}
    for path, value, origin in _items(overrides, faults):
        if path in parsed:
            faults.append(Fault((path,), "given twice", origin=origin))
        elif not all(path.split(".")):
            faults.append(Fault((path,), "not a dotted path", allowed="such as springs.stiffness", origin=origin))
        else:
            parsed[path] = _Override(tuple(path.split(".")), value, origin)
    return list(parsed.values())


def _items(overrides: Overrides, faults: list[Fault]) -> list[tuple[str, Any, str]]:
    if isinstance(overrides, Mapping):
        return [(str(path), plain(value), f"overrides[{path!r}]") for path, value in overrides.items()]
    items = []
    for text in [overrides] if isinstance(overrides, str) else overrides:
        path, _, yaml = text.partition("=")
        origin = f"--set {shortened(text)}"
        if not yaml.strip():
            faults.append(Fault((), "no value", allowed="PATH=VALUE, such as springs.stiffness=3e4", origin=origin))
            continue
        try:
            items.append((path.strip(), load_yaml(yaml, lambda _, origin=origin: origin)[0], origin))  # type: ignore[misc]
        except ScenarioError as error:
            faults.extend(error.faults)
    return items


def _set(data: dict[str, Any], override: _Override) -> tuple[Path, list[Path]]:
    """Set a value in place; returns its path and the paths of the sections made for it."""
    container: Any = data
    path: Path = ()
    made: list[Path] = []
    for key in override.keys[:-1]:
        step = _step(container, key, path, override)
        path = (*path, step)
        if isinstance(container, dict) and step not in container:
            container[step] = _blank(path)
            made.append(path)
        container = container[step]
    step = _step(container, override.keys[-1], path, override)
    container[step] = override.value
    return (*path, step), made


def _step(container: Any, key: str, path: Path, override: _Override) -> str | int:
    """A key as it enters a container: text for a mapping, a position for a list."""
    if isinstance(container, dict):
        return key
    if not isinstance(container, list):
        fault = Fault((*path, key), f"{dotted(path)} has no parts", shown(container), origin=override.origin)
        raise ScenarioError([fault])
    if key.isascii() and key.isdecimal() and len(key) < 10 and int(key) < len(container):
        return int(key)
    allowed = f"0 to {len(container) - 1}" if container else "none, the list is empty"
    raise ScenarioError([Fault((*path, key), "no such position in the list", key, allowed, origin=override.origin)])


def _blank(path: Path) -> Any:
    """What to start from where the document leaves a default: the default, or for sections an empty mapping."""
    default: Any = _defaults()
    for key in path:
        default = default.get(key, {}) if isinstance(default, dict) else {}
    return {} if isinstance(default, dict) else plain(default)


@functools.cache
def _defaults() -> dict[str, Any]:
    """The sections that a scenario may leave out, as they are then."""
    fields = {name: field for name, field in Scenario.model_fields.items() if not field.is_required()}
    values = {name: field.get_default(call_default_factory=True) for name, field in fields.items()}
    return {name: value.model_dump() for name, value in values.items() if isinstance(value, Section)}
