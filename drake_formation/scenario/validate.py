"""From plain data to a sound scenario, or to everything that is wrong with it."""

from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from drake_formation.config.errors import MESSAGES, Fault, nearest, shown
from drake_formation.config.errors import Path as PathInScenario
from drake_formation.parts.registry import broken, kinds
from drake_formation.parts.roles import ROLES
from drake_formation.scenario.fields import Place, chooser, locate, names
from drake_formation.scenario.resolve import check
from drake_formation.scenario.schema import Scenario
from drake_formation.scenario.source import Document


def validate(document: Document) -> Scenario:
    """A scenario from a document.

    Raises:
        ScenarioError: with all faults of single fields or, if there are none, all that concern several fields.
    """
    try:
        scenario = Scenario.model_validate(document.data, context={"folder": Path(document.name).parent})
    except ValidationError as error:
        details = error.errors(include_url=False)
        raise document.attributed(_fault(detail) for detail in details if not _is_echo(detail)) from error
    if faults := check(scenario):
        raise document.attributed(faults)
    return scenario


def _is_echo(detail: ErrorDetails) -> bool:
    """Whether a list is called too short only because its entries are wrong, which is told already."""
    return detail["type"] == "too_short" and len(detail["input"]) >= detail["ctx"]["min_length"]


def _fault(detail: ErrorDetails) -> Fault:
    kind, value = detail["type"], detail["input"]
    if kind == "missing" and isinstance(detail["loc"][-1], int):
        # A pair with one entry: pydantic misses the second, the user wrote too short a list.
        return _wrong(locate(detail["loc"][:-1]), value, "too_short")
    place = locate(detail["loc"])
    if kind.startswith("union_tag"):
        return _choice(place, value)
    if kind == "extra_forbidden":
        keys = place.section.model_fields
        allowed = ", ".join(keys) + _of_other_kinds(place.path)
        return Fault(place.path, MESSAGES[kind], allowed=allowed, suggestion=nearest(place.path[-1], keys))
    if kind == "missing":
        return Fault(place.path, MESSAGES[kind], allowed=place.allowed)
    if kind == "value_error":
        return Fault(place.path, str(detail["ctx"]["error"]), shown(value), place.allowed)
    return _wrong(place, value, kind)


def _of_other_kinds(path: PathInScenario) -> str:
    """With which kinds of part a field would be known that is not one of the kind chosen; nothing where with none."""
    *section, field = path
    for role in ROLES.values():
        if role.section == tuple(section):
            others = [kind for kind, part in kinds(role.name).items() if field in part.Config.model_fields]
            return f"; with {role.chooser}: {' or '.join(others)} also {field}" if others else ""
    return ""


def _wrong(place: Place, value: Any, kind: str) -> Fault:
    message = MESSAGES.get(kind, "not allowed")
    return Fault(place.path, message, shown(value), place.allowed, nearest(value, names(place.annotation)))


def _choice(place: Place, value: dict[str, Any]) -> Fault:
    """A formation's shape, or a reference's kind, chooses which other keys it has."""
    key, choices = chooser(place.annotation), names(place.annotation)
    path, allowed = (*place.path, key), ", ".join(choices)
    if key not in value:
        return Fault(path, "missing", allowed=allowed)
    return Fault(path, _unknown(value[key]), shown(value[key]), allowed, nearest(value[key], choices))


def _unknown(name: Any) -> str:
    """Why a kind is none here: perhaps it is one of another role, or its package is broken."""
    for role in ROLES if isinstance(name, str) else ():
        if name in kinds(role):
            return f"a kind of {role}, not of this"
        if name in broken(role):
            return broken(role)[name]
    return "unknown name"
