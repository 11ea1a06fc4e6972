"""Names and units of what a sweep varies and measures."""

import types
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel

from drake_formation.config.labels import name_of, unit_of
from drake_formation.measuring.registry import known
from drake_formation.scenario import Scenario
from drake_formation.scenario.written import PartOf


def metric_attributes(name: str) -> dict[str, str]:
    """Attributes of a metric's variable: units and long name."""
    metric = known().get(name)
    return {"units": metric.unit, "long_name": metric.label} if metric else {}


def metric_names() -> list[str]:
    """All metrics, in their order."""
    return list(known())


def field_attributes(path: str) -> dict[str, str]:
    """Attributes of a swept field's coordinate: its path, and name and unit as the scenario's schema says them."""
    attributes = {"path": path}
    text = _description(Scenario, path.split("."))
    unit = unit_of(text)
    if unit and "," not in unit:  # else one of its numbers has one of several
        attributes["units"] = unit
    if text:
        attributes["long_name"] = name_of(_key(path), text)
    return attributes


def _key(path: str) -> str:
    """The last key of a path that is not a position in a list."""
    return next((key for key in reversed(path.split(".")) if not key.isdecimal()), path)


def _description(annotation: Any, keys: list[str]) -> str:
    """The description of the innermost field that a path enters; empty if it leads nowhere."""
    for section in _sections(annotation):
        if keys and (field := section.model_fields.get(keys[0])):
            own = Annotated[field.annotation, *field.metadata] if field.metadata else field.annotation
            return _description(own, keys[1:]) or field.description or ""
    if keys and keys[0].isdecimal():
        return next(filter(None, (_description(item, keys[1:]) for item in _items(annotation))), "")
    return ""


def _sections(annotation: Any) -> list[type[BaseModel]]:
    """Sections that a type may be."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [section for branch in _branches(annotation) for section in _sections(branch)]


def _items(annotation: Any) -> list[Any]:
    """Types that the entries of a type may be."""
    if get_origin(annotation) is tuple:
        return [item for item in get_args(annotation) if item is not Ellipsis]
    return [item for branch in _branches(annotation) for item in _items(branch)]


def _branches(annotation: Any) -> tuple[Any, ...]:
    origin = get_origin(annotation)
    if origin is Annotated:
        part = next((item for item in get_args(annotation)[1:] if isinstance(item, PartOf)), None)
        return tuple(part.models().values()) if part else get_args(annotation)[:1]
    return get_args(annotation) if origin in (Union, types.UnionType) else ()
