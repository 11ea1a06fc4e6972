"""One value for all, or one for each: how a field of a robot's part, or of an edge's, may be written.

A part declares a plain field, ``kp: Positive``. In a scenario it may be one value for all, a list of as many values as
there are robots, or a mapping such as ``{1: 50.0, default: 40.0}``. Where the field itself is a list, as a matrix is,
a list is always one value for all, and a mapping tells the robots apart.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, get_args, get_origin

from pydantic import Discriminator, Field, Tag

from drake_formation.config.errors import Fault, Path, nearest, shown

DEFAULT = "default"
"""Key of a mapping for all that it does not name."""


def each(annotation: Any) -> Any:
    """The type of a field that may also be given for each robot or edge, from its own type."""
    branches = Annotated[annotation, Tag("scalar")] | Annotated[dict[str, annotation], Tag("mapping")]
    if is_list(annotation):
        return Annotated[branches, Discriminator(_scalar_or_mapping)]
    listed = Annotated[tuple[annotation, ...], Field(strict=False), Tag("list")]
    return Annotated[branches | listed, Discriminator(_scalar_list_or_mapping)]


def for_each(annotation: Any) -> Any:
    """The type of a field that is given for each robot, as a list or a mapping, and not once for all."""
    listed = Annotated[tuple[annotation, ...], Field(strict=False), Tag("list")]
    return Annotated[Annotated[dict[str, annotation], Tag("mapping")] | listed, Discriminator(_scalar_list_or_mapping)]


def is_list(annotation: Any) -> bool:
    """Whether a value of a type may be written as a list."""
    if get_origin(annotation) is Annotated:
        return is_list(get_args(annotation)[0])
    return get_origin(annotation) in (tuple, list) or any(is_list(branch) for branch in get_args(annotation))


def _scalar_or_mapping(value: Any) -> str:
    return "mapping" if isinstance(value, Mapping) else "scalar"


def _scalar_list_or_mapping(value: Any) -> str:
    return "list" if isinstance(value, list | tuple) else _scalar_or_mapping(value)


@dataclass(frozen=True)
class Owners:
    """Those for whom values are given: the robots, or the edges of a graph.

    Attributes:
        what: what one of them is called, ``robot`` or ``edge``.
        names: what each is called in a mapping, in the order of a list.
    """

    what: str
    names: tuple[str, ...]

    @classmethod
    def robots(cls, count: int) -> "Owners":
        """Robots, numbered from 1."""
        return cls("robot", tuple(str(i + 1) for i in range(count)))

    @classmethod
    def edges(cls, edges: Sequence[tuple[int, int]]) -> "Owners":
        """Edges between robots from 0, named ``1-2`` by the robots' numbers."""
        return cls("edge", tuple(f"{i + 1}-{j + 1}" for i, j in edges))

    @property
    def all_named(self) -> str:
        """Their names in words."""
        if self.what == "robot":
            return f"robots 1 to {len(self.names)}"
        return f"edges {', '.join(self.names)}" if self.names else "no edges"

    def value(self, written: Any, index: int, listed: bool, default: Any) -> Any:
        """The value of one of them.

        Args:
            written: one value for all, a list or a mapping.
            index: which of them.
            listed: whether a list is one value for all.
            default: what counts where a mapping names neither it nor ``default``.
        """
        if isinstance(written, Mapping):
            return written.get(self.names[index], written.get(DEFAULT, default))
        if isinstance(written, list | tuple) and not listed:
            return written[index]
        return written

    def faults(self, path: Path, written: Any, listed: bool, required: bool) -> Iterator[Fault]:
        """What is wrong with how values are handed out.

        Args:
            path: of the field.
            written: one value for all, a list or a mapping.
            listed: whether a list is one value for all.
            required: whether there is no default.
        """
        count = len(self.names)
        if isinstance(written, Mapping):
            yield from self._mapping_faults(path, written, required)
        elif isinstance(written, list | tuple) and not listed and len(written) != count:
            allowed = f"one for all, or {count}, one {'a' if self.what == 'robot' else 'an'} {self.what}"
            if self.what == "edge":
                allowed = f"one for all, or {count} in the order of the edges: {', '.join(self.names) or 'none'}"
            message = f"{len(written)} values for {count} {self.what}s"
            yield Fault(path, message, shown(written), allowed)

    def _mapping_faults(self, path: Path, written: Mapping[str, Any], required: bool) -> Iterator[Fault]:
        for name in written:
            if name not in self.names and name != DEFAULT:
                allowed = f"{self.all_named}, or {DEFAULT}"
                yield Fault((*path, name), f"there is no {self.what} {name}", "", allowed, nearest(name, [DEFAULT]))
        missing = [name for name in self.names if name not in written]
        if required and missing and DEFAULT not in written:
            yield Fault(path, f"no value for {self.what} {missing[0]}", shown(dict(written)), f"also {DEFAULT}: …")
