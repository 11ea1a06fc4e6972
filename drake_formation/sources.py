"""Sources as numbers, the package's own and its guests': results kept on disk say by them which code made them."""

import functools
import hashlib
from importlib.metadata import entry_points
from importlib.util import find_spec
from pathlib import Path

OWN, SESSION = "drake-formation", "this session"
"""Where parts and metrics come from, beside other packages: the distribution of this one, and a notebook."""

PART_POINTS, METRIC_POINTS = "drake_formation.parts", "drake_formation.metrics"
"""Groups of entry points by which other packages bring them: ``my_law = "my_package.my_law:MyLaw"``."""


@functools.cache
def source_hash() -> str:
    """SHA-256 of all Python files of the package as they are at the first call, 64 hexadecimal digits.

    Names and contents count, folders and times do not, so that two installations of the same code agree.
    """
    return hash_of(Path(__file__).parent)


@functools.cache
def guest_hashes() -> dict[str, str]:
    """The same of every other package that brings parts or metrics, by the name of its module; empty if none does."""
    points = (entry for group in (PART_POINTS, METRIC_POINTS) for entry in entry_points(group=group))
    modules = {entry.module.partition(".")[0] for entry in points}
    return {name: _hash_of_module(name) for name in sorted(modules)}


def _hash_of_module(name: str) -> str:
    spec = find_spec(name)
    if spec is None:
        return "missing"
    if spec.submodule_search_locations:
        return "".join(hash_of(Path(folder)) for folder in spec.submodule_search_locations)
    return hashlib.sha256(Path(spec.origin).read_bytes() if spec.origin else b"").hexdigest()


def hash_of(folder: Path) -> str:
    """SHA-256 of all Python files under a folder, by their names relative to it and what they hold."""
    result = hashlib.sha256()
    files = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*.py")}
    for name in sorted(files):
        content = files[name].read_bytes()
        result.update(f"{name}\n{len(content)}\n".encode())
        result.update(content)
    return result.hexdigest()
