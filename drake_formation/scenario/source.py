"""Scenario files as plain data that remembers its lines.

The parser knows YAML 1.2 only, whatever a file declares: ``yes`` is text and ``1e4`` a number. It builds
mappings, lists, numbers, booleans, text and null; no other object can come out of a file. The one thing it takes from
YAML 1.1 is the merge key: ``<<: *base`` stands for the entries of ``base`` that the mapping does not give itself.
"""

import os
import stat
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from ruamel.yaml.resolver import VersionedResolver

from drake_formation.config.errors import Fault, Path, ScenarioError, shown

_MOST_VALUES = 300_000
"""More than any scenario needs; stops aliases that multiply without end."""

MOST_BYTES = 2_000_000
"""Of a file; a scenario of a thousand robots has some ten thousand."""

_ALLOWED = f"a regular file of UTF-8 text, at most {MOST_BYTES // 10**6} MB"

_TAG = "tag:yaml.org,2002:"
_MERGE = _TAG + "merge"


@dataclass(frozen=True)
class Document:
    """Data of a scenario, not yet validated, and where each part of it was written.

    Attributes:
        name: what to call the whole of it, such as the file's path.
        data: mappings, lists and scalars.
        origins: where the value at a path was written; a value without one was written where its parent was.
    """

    name: str
    data: dict[str, Any]
    origins: dict[Path, str] = field(default_factory=dict)

    def origin(self, path: Path) -> str:
        """Where the value at a path, or the nearest thing around it, was written."""
        prefixes = (path[:length] for length in range(len(path), -1, -1))
        return next((self.origins[prefix] for prefix in prefixes if prefix in self.origins), self.name)

    def attributed(self, faults: Iterable[Fault]) -> ScenarioError:
        """An error of the given faults, each with its origin in this document."""
        return ScenarioError(replace(fault, origin=fault.origin or self.origin(fault.path)) for fault in faults)


def read(path: FilePath) -> Document:
    """Read a scenario file.

    Raises:
        ScenarioError: as for :func:`read_text`, or the file is not one YAML mapping.
    """
    return parse(read_text(path), str(path))


def read_text(path: FilePath) -> str:
    """Text of a file that a user named: whatever else the name leads to is not waited for.

    Raises:
        ScenarioError: it cannot be read, is not a regular file or too large for one of these, or is not UTF-8 text.
    """
    content = b""
    try:
        # Opening a pipe that nobody writes to would wait; this does not.
        with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK), "rb") as file:  # noqa: PTH123 (a descriptor)
            problem = "" if stat.S_ISREG(os.fstat(file.fileno()).st_mode) else "not a regular file"
            if not problem:
                content = file.read(MOST_BYTES + 1) or b""
        problem = "too large" if len(content) > MOST_BYTES else problem
        text = content.decode("utf-8")
    except UnicodeDecodeError:
        problem = problem or "not UTF-8 text"
    except (OSError, ValueError) as error:
        problem = f"cannot be read: {(isinstance(error, OSError) and error.strerror) or error}"
    if problem:
        raise ScenarioError([Fault((), problem, allowed=_ALLOWED, origin=str(path))])
    return text


def parse(text: str, name: str) -> Document:
    """Read a scenario's text.

    Args:
        text: YAML 1.2.
        name: what to call it in messages, usually its file.

    Raises:
        ScenarioError: not one YAML mapping, duplicate keys, keys that are not text, foreign tags.
    """
    data, origins = load_yaml(text, lambda line: f"{name}:{line}")
    if data is None:
        raise ScenarioError([Fault((), "empty", allowed="a scenario (a YAML mapping)", origin=name)])
    if not isinstance(data, dict):
        fault = Fault((), "not a mapping", shown(data), "a scenario (a YAML mapping)", origin=origins[()])
        raise ScenarioError([fault])
    return Document(name, data, origins)


def load_yaml(text: str, origin: Callable[[int], str]) -> tuple[Any, dict[Path, str]]:
    """Plain data from YAML 1.2 text.

    Args:
        text: one YAML document.
        origin: what to call a line (from 1).

    Returns:
        The data, and the origin of every value by its path. A value under a key is said to stand at its key.

    Raises:
        ScenarioError: as for :func:`parse`.
    """
    builder = _Builder(origin)
    try:
        node = _compose(text)
        data = None if node is None else builder.build(node, (), _line(node))
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        message = f"not valid YAML: {', '.join(filter(None, [error.context, error.problem]))}"
        raise ScenarioError([Fault((), message, origin=origin(mark.line + 1 if mark else 1))]) from error
    except YAMLError as error:
        raise ScenarioError([Fault((), f"not valid YAML: {error}", origin=origin(1))]) from error
    except RecursionError as error:
        raise ScenarioError([Fault((), "nested too deeply", origin=origin(1))]) from error
    if builder.faults:
        raise ScenarioError(builder.faults)
    return data, builder.origins


class _Resolver(VersionedResolver):
    """YAML 1.2, even under a ``%YAML 1.1`` directive that would turn ``yes`` into a boolean."""

    processing_version = (1, 2)


def _compose(text: str) -> Node | None:
    yaml = YAML(typ="safe", pure=True)
    yaml.Resolver = _Resolver
    yaml.composer.warn_double_anchors = False  # reusing an anchor is legal
    try:
        node: Node | None = yaml.compose(text)
    except (ArithmeticError, AssertionError, AttributeError, LookupError, TypeError, ValueError) as error:
        # The parser lets a few of these slip on malformed escapes and directives.
        raise YAMLError(str(error)) from error
    return node


def _line(node: Node) -> int:
    return int(node.start_mark.line) + 1


class _Builder:
    """Nodes to plain data, noting origins and collecting faults on the way."""

    def __init__(self, origin: Callable[[int], str]) -> None:
        self.origins: dict[Path, str] = {}
        self.faults: list[Fault] = []
        self._origin = origin
        self._open: set[int] = set()
        self._merged = 0

    def build(self, node: Node, path: Path, line: int) -> Any:
        """Data of a node that stands at a path, on a line."""
        self.origins[path] = self._origin(line)
        if len(self.origins) > _MOST_VALUES:
            raise YAMLError(f"more than {_MOST_VALUES} values")
        if isinstance(node, ScalarNode):
            return self._scalar(node, path, line)
        if id(node) in self._open:
            return self._fault(path, "an alias that contains itself", line)
        if node.tag not in (_TAG + "map", _TAG + "seq"):
            return self._fault(path, f"tag {node.tag} is not allowed", line)
        self._open.add(id(node))
        data = self._mapping(node, path) if isinstance(node, MappingNode) else self._list(node, path)
        self._open.remove(id(node))
        return data

    def _list(self, node: Node, path: Path) -> list[Any]:
        return [self.build(item, (*path, index), _line(item)) for index, item in enumerate(node.value)]

    def _mapping(self, node: MappingNode, path: Path) -> dict[str, Any]:
        data: dict[str, Any] = {}
        lines: dict[str, int] = {}
        for key_node, value_node in self._entries(node, path):
            line = _line(key_node)
            key = self._scalar(key_node, path, line) if isinstance(key_node, ScalarNode) else []
            if isinstance(key, int) and not isinstance(key, bool):
                key = str(key)  # the number of a robot
            if not isinstance(key, str):
                self._fault(path, "a key that is not text", line, shown(key) if key != [] else "")
            elif key in data:
                self._fault((*path, key), f"given twice, first on line {lines[key]}", line)
            else:
                lines[key] = line
                data[key] = self.build(value_node, (*path, key), line)
        return data

    def _entries(self, node: MappingNode, path: Path) -> list[tuple[Node, Node]]:
        """Keys and values of a mapping, then those that it merges in; of equal ones there, the first counts."""
        entries = [(key, value) for key, value in node.value if key.tag != _MERGE]
        given = {key.value for key, _ in entries if isinstance(key, ScalarNode)}
        merges = [(_line(key), value) for key, value in node.value if key.tag == _MERGE]
        for line, _ in merges[1:]:
            self._fault((*path, "<<"), f"given twice, first on line {merges[0][0]}", line, allowed="a list of mappings")
        for line, value in merges[:1]:
            for base in value.value if isinstance(value, SequenceNode) else [value]:
                for inherited, its_value in self._base_entries(base, path, line):
                    if inherited.value not in given:
                        entries.append((inherited, its_value))
                        given.add(inherited.value)
        return entries

    def _base_entries(self, base: Node, path: Path, line: int) -> list[tuple[ScalarNode, Node]]:
        if not isinstance(base, MappingNode):
            self._fault((*path, "<<"), "merges what is not a mapping", line, allowed="a mapping, or a list of them")
            return []
        if id(base) in self._open:
            self._fault((*path, "<<"), "an alias that contains itself", line)
            return []
        self._merged += 1
        if self._merged > _MOST_VALUES:
            raise YAMLError(f"more than {_MOST_VALUES} merges")
        self._open.add(id(base))
        entries = [(key, value) for key, value in self._entries(base, path) if isinstance(key, ScalarNode)]
        self._open.remove(id(base))
        return entries

    def _scalar(self, node: ScalarNode, path: Path, line: int) -> Any:
        kind = str(node.tag).removeprefix(_TAG)
        convert = _SCALARS.get(kind)
        if convert is None:
            return self._fault(path, f"tag {node.tag} is not allowed", line)
        try:
            return convert(node.value)
        except (ValueError, KeyError):
            return self._fault(path, f"not a valid {kind}", line, shown(node.value))

    def _fault(self, path: Path, message: str, line: int, value: str = "", allowed: str = "") -> None:
        self.faults.append(Fault(path, message, value, allowed, origin=self._origin(line)))


def _integer(text: str) -> int:
    prefixed = text.lstrip("+-")[:2] in ("0x", "0o", "0b")
    return int(text, 0 if prefixed else 10)


def _number(text: str) -> float:
    return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))


_SCALARS: dict[str, Callable[[str], Any]] = {
    "null": lambda _: None,
    "bool": lambda text: {"true": True, "false": False}[text.lower()],
    "int": _integer,
    "float": _number,
    "str": str,
    # Types beyond YAML 1.2's core: dates, default values and << where no key stands are text here.
    "timestamp": str,
    "merge": str,
    "value": str,
}
