"""The parts there are: those of this package, those of installed ones, and those that a session registers."""

import functools
import importlib
import pkgutil
import threading
from collections.abc import Callable
from importlib.metadata import EntryPoint, entry_points
from typing import Any, TypeVar

from drake_formation.parts.part import Part
from drake_formation.parts.roles import ROLES
from drake_formation.sources import PART_POINTS, SESSION

Class = TypeVar("Class", bound=type[Part])

_FINDING = threading.RLock()
_parts: dict[str, dict[str, type[Part]]] = {role: {} for role in ROLES}
_broken: dict[str, dict[str, str]] = {role: {} for role in ROLES}
_listeners: list[Callable[[], None]] = []


class PartError(TypeError):
    """A part that cannot be used, with its name and where it comes from."""


def part(role: str, *, kind: str) -> Callable[[Class], Class]:
    """Name a part's role and kind: a decorator of its class, which registers nothing yet.

    Args:
        role: a key of :data:`drake_formation.parts.roles.ROLES`.
        kind: its name in scenarios.

    Raises:
        PartError: there is no such role.
    """
    if role not in ROLES:
        raise PartError(f"part {kind!r}: there is no role {role!r}; there are {', '.join(ROLES)}")

    def named(cls: Class) -> Class:
        cls.role, cls.kind = role, kind
        return cls

    return named


def register(cls: Class) -> Class:
    """Make a part known for this session, as a notebook does; a decorator, or called with the class.

    A part of the same name that this session registered before is replaced, so that a cell may run again.

    Raises:
        PartError: it is no part, or has the name of one that an installed package brings.
    """
    find_all()
    _require_part(cls, SESSION)
    known = _parts[cls.role].get(cls.kind)
    if known and known.distribution != SESSION:
        raise PartError(f"{cls.called()}: {known.distribution} has a part of this name; give it another kind")
    cls.distribution = SESSION
    _parts[cls.role][cls.kind] = cls
    _told()
    return cls


def find(role: str, kind: str) -> type[Part]:
    """A part by its role and kind.

    Raises:
        PartError: there is none, or it is broken.
    """
    find_all()
    if kind in _broken[role]:
        raise PartError(_broken[role][kind])
    if kind not in _parts[role]:
        raise PartError(f"there is no {role} {kind!r}; there are {', '.join(_parts[role])}")
    return _parts[role][kind]


def kinds(role: str) -> dict[str, type[Part]]:
    """All parts of a role by kind, this package's first."""
    find_all()
    return dict(_parts[role])


def broken(role: str) -> dict[str, str]:
    """Parts of installed packages that cannot be used, by kind, and why."""
    find_all()
    return dict(_broken[role])


def when_changed(listener: Callable[[], None]) -> None:
    """Call a function whenever a part has been registered; the schema of scenarios follows so."""
    _listeners.append(listener)


def find_all() -> None:
    """Import the parts of this package, and those that installed packages announce; once."""
    with _FINDING:
        _find_all()


@functools.cache
def _find_all() -> None:
    import drake_formation.parts as package

    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        for value in vars(importlib.import_module(module.name)).values():
            if _is_part(value) and value.__module__ == module.name:
                _parts[value.role][value.kind] = value
    for role, known in _parts.items():  # the default of a role stands first where kinds are listed
        default = ROLES[role].default
        _parts[role] = {default: known[default], **known}
    for entry in entry_points(group=PART_POINTS):
        _load(entry)


def _load(entry: EntryPoint) -> None:
    """Take in a part of an installed package; what is wrong with it is told when a scenario asks for it."""
    distribution = entry.dist.name if entry.dist else entry.value
    try:
        cls: Any = entry.load()
        _require_part(cls, distribution)
    except Exception as error:  # whatever another package raises is its own
        for role in ROLES:
            _broken[role].setdefault(entry.name, f"part {entry.name!r} of {distribution} cannot be used: {error}")
        return
    known = _parts[cls.role].get(cls.kind)
    if known:
        message = f"{cls.role} {cls.kind!r} is in {known.distribution} and in {distribution}; remove one of them"
        _broken[cls.role][cls.kind] = message
        return
    cls.distribution = distribution
    _parts[cls.role][cls.kind] = cls


def _is_part(value: Any) -> bool:
    return isinstance(value, type) and issubclass(value, Part) and "kind" in vars(value)


def _require_part(cls: Any, distribution: str) -> None:
    if not _is_part(cls):
        name = getattr(cls, "__name__", repr(cls))
        raise PartError(f"{name!r} of {distribution} is no part: a subclass of Part with @part(role, kind=…) is one")


def _told() -> None:
    for listener in _listeners:
        listener()
