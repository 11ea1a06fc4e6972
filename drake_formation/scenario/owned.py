"""A section as written, handed out: one part for every robot, edge or channel."""

from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from drake_formation.config.each import DEFAULT, Owners
from drake_formation.config.errors import MESSAGES, Fault, Path, nearest, shown
from drake_formation.parts.part import Part
from drake_formation.parts.registry import PartError, find, kinds
from drake_formation.parts.roles import ROLES, Role
from drake_formation.scenario.schema import Scenario
from drake_formation.scenario.written import takes_lists


def section(scenario: Scenario, role: str) -> Any:
    """The section of a role in a scenario."""
    found: Any = scenario
    for key in ROLES[role].section:
        found = getattr(found, str(key))
    return found


def handed_out(scenario: Scenario, role: str, owners: Owners) -> tuple[tuple[Part, ...], list[Fault]]:
    """The parts of a role, one for each owner; or what is wrong with how they are given.

    Where all are alike, they are one object.

    Args:
        scenario: its single fields are valid.
        role: name of the role.
        owners: for whom there is one part each.
    """
    its, written = ROLES[role], section(scenario, role)
    chosen = getattr(written, its.chooser)
    if faults := list(owners.faults((*its.section, its.chooser), chosen, listed=False, required=False)):
        return (), faults
    try:
        if isinstance(chosen, str):
            classes = [find(role, chosen)] * len(owners.names)
        else:
            classes = [find(role, owners.value(chosen, i, False, its.default)) for i in range(len(owners.names))]
    except PartError as error:
        return (), [Fault((*its.section, its.chooser), str(error))]
    if faults := list(_field_faults(its, written, set(classes), owners)):
        return (), faults
    given = {cls: _Given(written, cls, owners) for cls in set(classes)}
    parts: list[Part] = []
    known: dict[Any, Part | None] = {}
    if len(given) == 1 and not given[classes[0]].differing:
        part = _part(its, classes[0], given[classes[0]].values(()), faults)
        return ((part,) * len(classes) if part else ()), list(dict.fromkeys(faults))
    for index, cls in enumerate(classes):
        own = given[cls].own(index)
        if (cls, own) not in known:
            known[cls, own] = _part(its, cls, given[cls].values(own), faults)
        if part := known[cls, own]:
            parts.append(part)
    return tuple(parts), list(dict.fromkeys(faults))


class _Given:
    """What a section says of the fields of one kind of part: what is alike for all, and what differs.

    Args:
        written: the section.
        cls: the part.
        owners: for whom values are given.
    """

    def __init__(self, written: Any, cls: type[Part], owners: Owners) -> None:
        self._alike: dict[str, Any] = {}
        self.differing: dict[str, tuple[Any, bool, Any]] = {}
        self._owners = owners
        for name, info in cls.Config.model_fields.items():
            if name not in type(written).model_fields or not _is_set(written, name):
                continue
            value, listed = _hashable(getattr(written, name)), takes_lists(cls, name)
            if isinstance(value, dict) or (isinstance(value, tuple) and not listed):
                self.differing[name] = value, listed, info.get_default(call_default_factory=True)
            else:
                self._alike[name] = value

    def own(self, index: int) -> tuple[Any, ...]:
        """The values of one owner that may differ from others'."""
        return tuple([self._owners.value(value, index, *more) for value, *more in self.differing.values()])

    def values(self, own: tuple[Any, ...]) -> dict[str, Any]:
        """All values of an owner, from its own."""
        return self._alike | dict(zip(self.differing, own, strict=True))


def path_of(scenario: Scenario, role: str, owner: int, path: Path) -> Path:
    """Where a fault of a part stands in the scenario.

    Args:
        scenario: as written.
        role: name of the part's role.
        owner: index of its robot, edge or channel.
        path: inside the part's section; ``..`` leads out of it.
    """
    result: list[str | int] = list(ROLES[role].section)
    for key in path:
        if key == "..":
            result.pop()
        else:
            result.append(key)
    kind = getattr(section(scenario, role), ROLES[role].chooser)
    if len(path) == 1 and isinstance(kind, str) and path[0] in kinds(role)[kind].Config.model_fields:
        field = str(path[0])
        value = getattr(section(scenario, role), field)
        if isinstance(value, dict):
            name = str(owner + 1)
            result.append(name if name in value else DEFAULT)
        elif isinstance(value, tuple) and not takes_lists(kinds(role)[kind], field):
            result.append(owner)
    return tuple(result)


def _hashable(value: Any) -> Any:
    """A value with tuples for lists, which are as they were written where kinds are mixed."""
    if isinstance(value, dict):
        return {key: _hashable(item) for key, item in value.items()}
    return tuple(map(_hashable, value)) if isinstance(value, list | tuple) else value


def _is_set(written: Any, name: str) -> bool:
    return name in written.model_fields_set or getattr(written, name) is not None


def _field_faults(role: Role, written: Any, classes: set[type[Part]], owners: Owners) -> Iterator[Fault]:
    """How values are handed out, field by field; and fields that no part here has."""
    fields: dict[str, type[Part]] = {name: cls for cls in classes for name in cls.Config.model_fields}
    for name in sorted(fields, key=list(type(written).model_fields).index):
        value, cls = getattr(written, name), fields[name]
        required = cls.Config.model_fields[name].is_required()
        yield from owners.faults((*role.section, name), value, listed=takes_lists(cls, name), required=required)


def _part(role: Role, cls: type[Part], values: dict[str, Any], faults: list[Fault]) -> Part | None:
    """A part with some values; what is wrong with its configuration is added to the faults."""
    try:
        return cls(cls.Config.model_validate(values))
    except ValidationError as error:
        for detail in error.errors(include_url=False):
            message = MESSAGES.get(detail["type"], detail["msg"])
            path = (*role.section, *detail["loc"])
            allowed = ", ".join(cls.Config.model_fields)
            faults.append(Fault(path, message, shown(detail["input"]), allowed, nearest(path[-1], [])))
        return None
