"""Parts as a user writes them: for every role a union over the kinds there are, which follows what is registered."""

import functools
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler, create_model, model_serializer
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from drake_formation.config.each import each, for_each, is_list
from drake_formation.config.values import Section
from drake_formation.parts.part import Part
from drake_formation.parts.registry import kinds
from drake_formation.parts.roles import ROLES, Role

MIXED = "mixed"
"""The branch of a section whose kind differs between robots."""


class PartOf:
    """Annotates a field of the scenario: a part of a role, by any of its kinds.

    Args:
        role: name of the role.
        shared: fields that the section has whatever the kind.
    """

    def __init__(self, role: str, shared: type[Section] = Section) -> None:
        self.role: Role = ROLES[role]
        self.shared = shared

    def __get_pydantic_core_schema__(self, _source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """A union over the kinds that are registered now."""
        choices = {name: handler.generate_schema(model) for name, model in self.models().items()}
        return core_schema.tagged_union_schema(choices, discriminator=self.chosen)

    def models(self) -> dict[str, type[Section]]:
        """The section as it is written, by kind."""
        parts: dict[str, Any] = dict(kinds(self.role.name))
        models: dict[str, type[Section]] = {kind: written(part, self.shared) for kind, part in parts.items()}
        if self.may_differ:
            models[MIXED] = mixed(self.role.name, self.shared, tuple(parts.values()))
        return models

    @property
    def may_differ(self) -> bool:
        """Whether robots may have parts of different kinds."""
        return self.role.owner == "robot"

    @property
    def kind_required(self) -> bool:
        """Whether a section that is there must say its kind."""
        return self.role.owner == "formation"

    def chosen(self, value: Any) -> Any:
        """The branch that a value takes."""
        chooser = self.role.chooser
        if isinstance(value, Mapping):
            kind = value.get(chooser, None if self.kind_required else self.role.default)
        else:
            kind = getattr(value, chooser, self.role.default)
        return MIXED if self.may_differ and isinstance(kind, Mapping | list | tuple) else kind

    def default(self) -> Any:
        """The section where a scenario leaves it out."""
        kind = self.role.default
        part: Any = kinds(self.role.name)[kind]
        return written(part, self.shared).model_validate({self.role.chooser: kind})


@functools.cache
def written(part: Any, shared: Any) -> type[Section]:
    """The section of one kind as it is written: its fields may also be given for each robot or edge."""
    role = ROLES[part.role]
    kind = _kind_field(role, part.kind)
    name = "".join(word.capitalize() for word in (part.kind + "_" + role.name).split("_"))
    fields: dict[str, Any] = {role.chooser: (Literal[part.kind], kind)}
    fields |= {name: (_own(info), _field(info)) for name, info in shared.model_fields.items()}
    fields |= {name: (_annotation(info, role), _field(info)) for name, info in part.Config.model_fields.items()}
    section: type[Section] = create_model(name, __base__=Section, __doc__=part.__doc__, **fields)
    _made.append(section)
    return section


@functools.cache
def mixed(role: str, shared: Any, parts: tuple[Any, ...]) -> type[Section]:
    """The section where robots have parts of different kinds: all their fields, checked robot by robot."""
    names: Any = Literal.__getitem__(tuple(part.kind for part in parts))
    known = {
        name: (Any, Field(default=None, description=info.description))
        for part in parts
        for name, info in part.Config.model_fields.items()
    }
    kind = (for_each(names), Field(description=f"kind of {role}, a list or a mapping: one a robot"))

    class Mixed(shared):  # type: ignore[misc]
        @model_serializer(mode="wrap")
        def _as_written(self, handler: Any) -> dict[str, Any]:
            given: dict[str, Any] = handler(self)
            return {key: value for key, value in given.items() if key not in known or key in self.model_fields_set}

    fields: dict[str, Any] = {"kind": kind, **known}
    section: type[Section] = create_model(
        f"Mixed{role.capitalize()}", __base__=Mixed, __doc__="Parts of different kinds.", **fields
    )
    return section


_made: list[type[Section]] = []


def rebuild_sections() -> None:
    """Let the sections made hold such others as follow the parts there are now."""
    for section in _made:
        section.model_rebuild(force=True)


def takes_lists(part: type[Part], field: str) -> bool:
    """Whether a list is one value of a part's field, and not one for each robot."""
    config: Any = part.Config
    return field in _listed_fields(config)


@functools.lru_cache(maxsize=1024)
def _listed_fields(config: Any) -> frozenset[str]:
    """Fields of a configuration of which a value may be a list."""
    return frozenset(name for name, info in config.model_fields.items() if is_list(info.annotation))


def _annotation(info: FieldInfo, role: Role) -> Any:
    return _own(info) if role.owner == "formation" else each(_own(info))


def _own(info: FieldInfo) -> Any:
    return Annotated[info.annotation, *info.metadata] if info.metadata else info.annotation


def _field(info: FieldInfo) -> Any:
    options: dict[str, Any] = {"description": info.description}
    if info.default_factory is not None:
        options["default_factory"] = info.default_factory
    elif not info.is_required():
        options["default"] = info.default
    return Field(**options)


def _kind_field(role: Role, kind: str) -> Any:
    """The chooser; only a section of the default kind may leave it out."""
    descriptions = {"spring": "how the object acts: hookean along the line (Eq. 2), linear as the paper's Eqs. 4-7"}
    description = descriptions.get(role.name, f"kind of {role.name}")
    may_leave_out = role.owner != "formation" and kind == role.default
    return Field(default=kind, description=description) if may_leave_out else Field(description=description)
