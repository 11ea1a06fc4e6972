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
        classes = [find(role, owners.value(chosen, i, False, its.default)) for i in range(len(owners.names))]
    except PartError as error:
        return (), [Fault((*its.section, its.chooser), str(error))]
    if faults := list(_field_faults(its, written, set(classes), owners)):
        return (), faults
    given = {cls: _given(written, cls) for cls in set(classes)}
    parts: list[Part] = []
    alike: dict[type[Part], Part] = {}
    for index, cls in enumerate(classes):
        part = alike.get(cls) or _part(its, written, cls, given[cls], owners, index, faults)
        if part is None:
            continue
        if not any(_differs(written, cls, name) for name in given[cls]):
            alike[cls] = part
        parts.append(part)
    return tuple(parts), list(dict.fromkeys(faults))


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


def _given(written: Any, cls: type[Part]) -> list[str]:
    """Fields of a part that its section has a value for."""
    return [name for name in cls.Config.model_fields if name in type(written).model_fields and _is_set(written, name)]


def _is_set(written: Any, name: str) -> bool:
    return name in written.model_fields_set or getattr(written, name) is not None


def _differs(written: Any, cls: type[Part], name: str) -> bool:
    value = getattr(written, name)
    return isinstance(value, dict) or (isinstance(value, tuple) and not takes_lists(cls, name))


def _field_faults(role: Role, written: Any, classes: set[type[Part]], owners: Owners) -> Iterator[Fault]:
    """How values are handed out, field by field; and fields that no part here has."""
    fields: dict[str, type[Part]] = {name: cls for cls in classes for name in cls.Config.model_fields}
    for name in sorted(fields, key=list(type(written).model_fields).index):
        value, cls = getattr(written, name), fields[name]
        required = cls.Config.model_fields[name].is_required()
        yield from owners.faults((*role.section, name), value, listed=takes_lists(cls, name), required=required)


def _part(
    role: Role, written: Any, cls: type[Part], given: list[str], owners: Owners, index: int, faults: list[Fault]
) -> Part | None:
    """One owner's part; what is wrong with its configuration is added to the faults."""
    values = {}
    for name in given:
        info = cls.Config.model_fields[name]
        default = info.get_default(call_default_factory=True)
        values[name] = owners.value(getattr(written, name), index, takes_lists(cls, name), default)
    try:
        return cls(cls.Config.model_validate(values))
    except ValidationError as error:
        for detail in error.errors(include_url=False):
            message = MESSAGES.get(detail["type"], detail["msg"])
            path = (*role.section, *detail["loc"])
            allowed = ", ".join(cls.Config.model_fields)
            faults.append(Fault(path, message, shown(detail["input"]), allowed, nearest(path[-1], [])))
        return None
