"""The schema in words: what may stand at a place of a scenario."""

import types
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, MinLen
from pydantic import Tag
from pydantic.fields import FieldInfo

from drake_formation.config.each import DEFAULT
from drake_formation.config.errors import Path
from drake_formation.config.values import Section
from drake_formation.scenario.schema import Scenario
from drake_formation.scenario.written import MIXED, PartOf


@dataclass(frozen=True)
class Place:
    """A place of the schema.

    Attributes:
        path: where it is in a scenario.
        section: the section around it.
        annotation: what its value may be; None for an unknown key.
        description: what its field means, with the unit.
    """

    path: Path
    section: type[Section]
    annotation: Any
    description: str

    @property
    def allowed(self) -> str:
        """What may stand here, in words."""
        return " — ".join(filter(None, [phrase(self.annotation), self.description]))


def locate(loc: Path) -> Place:
    """The place of a pydantic error.

    Args:
        loc: pydantic's location, which also names the branch taken at every union; a user wrote no such name.
    """
    path: Path = ()
    section: type[Section] = Scenario
    here: Any = Scenario
    annotation: Any = Scenario
    description = ""
    for part in loc:
        if part == "[key]":
            continue  # what pydantic adds where a key of a mapping is wrong
        bare, _ = _unwrapped(annotation)
        if _is_union(bare):
            annotation = _branch(bare, part)
            continue
        path = (*path, part)
        if not _is_section(bare):
            here = annotation = _item(bare, part)
            continue
        section = bare
        field = bare.model_fields.get(part)
        if field is None:
            return Place(path, section, None, "")
        here = annotation = Annotated[field.annotation, *field.metadata] if field.metadata else field.annotation
        description = field.description or ""
    return Place(path, section, here, description)


def phrase(annotation: Any) -> str:
    """What a type allows, in words."""
    bare, bounds = _unwrapped(annotation)
    if _is_union(bare):
        return " or ".join(dict.fromkeys(phrase(branch) for branch in _branches(bare)))
    if get_origin(bare) is Literal:
        return ", ".join(map(str, get_args(bare)))
    if get_origin(bare) is tuple:
        return _list_phrase(get_args(bare), bounds)
    if get_origin(bare) is dict:
        return f"a mapping {{1: …, {DEFAULT}: …}}"
    if _is_section(bare):
        return f"a mapping {{{', '.join(bare.model_fields)}}}"
    return " ".join([_NAMES[bare], " and ".join(bounds)]).strip()


def names(annotation: Any) -> list[str]:
    """Names among which a value may choose: literals, or the shapes or kinds of a union of sections."""
    bare, _ = _unwrapped(annotation)
    if get_origin(bare) is Literal:
        return [str(name) for name in get_args(bare)]
    if _is_section(bare):
        key = next((key for key in CHOOSERS if key in bare.model_fields), None)  # others are fields like any
        return names(bare.model_fields[key].annotation) if key else []
    return [name for branch in _branches(bare) for name in names(branch)] if _is_union(bare) else []


def chooser(annotation: Any) -> str:
    """The key that chooses between the sections of a union."""
    bare, _ = _unwrapped(annotation)
    if isinstance(bare, PartOf):
        return bare.role.chooser
    sections = [_unwrapped(branch)[0] for branch in get_args(bare)]
    return next(key for key in CHOOSERS for section in sections if key in section.model_fields)


CHOOSERS = ("shape", "kind", "law")
"""Keys by which a section says which of several it is."""

_NAMES: dict[Any, str] = {
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    str: "text",
    type(None): "null",
}


def _list_phrase(items: tuple[Any, ...], bounds: list[str]) -> str:
    if items[-1] is not Ellipsis:
        return f"a list of {len(items)}, each {phrase(items[0])}"
    return " ".join(["a list", *bounds]) + f", each {phrase(items[0])}"


def _unwrapped(annotation: Any) -> tuple[Any, list[str]]:
    """A type without what annotates it and without an optional null, and its bounds in words."""
    bounds: list[str] = []
    if get_origin(annotation) is Annotated:
        annotation, *metadata = get_args(annotation)
        for item in metadata:
            if isinstance(item, PartOf):
                return item, bounds
        for item in metadata:
            bounds += [_bound(part) for part in (item.metadata if isinstance(item, FieldInfo) else [item])]
    if _is_union(annotation) and type(None) in get_args(annotation):
        (annotation,) = (branch for branch in get_args(annotation) if branch is not type(None))
        annotation, inner = _unwrapped(annotation)
        bounds += inner
    return annotation, [bound for bound in bounds if bound]


def _bound(constraint: Any) -> str:
    match constraint:
        case Gt(gt=limit):
            return f"> {limit:.10g}"
        case Ge(ge=limit):
            return f">= {limit:.10g}"
        case Le(le=limit):
            return f"<= {limit:.10g}"
        case MinLen(min_length=length):
            return f"of at least {length}"
    return ""


def _item(bare: Any, index: str | int) -> Any:
    """Type of an entry of a list."""
    items = get_args(bare)
    if get_origin(bare) is dict:
        return items[1]
    return items[0] if items[-1] is Ellipsis else items[min(int(index), len(items) - 1)]


def _tag(branch: Any) -> str:
    """Pydantic's name of a branch of a union."""
    for item in get_args(branch)[1:] if get_origin(branch) is Annotated else ():
        if isinstance(item, Tag):
            return item.tag
    return names(branch)[0]


def _branches(bare: Any) -> tuple[Any, ...]:
    """What a union is of."""
    if isinstance(bare, PartOf):
        return tuple(model for kind, model in bare.models().items() if kind != MIXED)
    return get_args(bare)


def _branch(bare: Any, tag: str | int) -> Any:
    """The branch of a union that pydantic calls by a tag."""
    if isinstance(bare, PartOf):
        return bare.models()[str(tag)]
    return next(branch for branch in get_args(bare) if _tag(branch) == tag)


def _is_union(bare: Any) -> bool:
    return isinstance(bare, PartOf) or get_origin(bare) in (Union, types.UnionType)


def _is_section(bare: Any) -> bool:
    return isinstance(bare, type) and issubclass(bare, Section)
