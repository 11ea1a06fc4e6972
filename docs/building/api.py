"""The public API, as mkdocstrings reads it from the packages: what their ``__all__`` says."""

from importlib import import_module
from importlib.util import find_spec
from pkgutil import walk_packages
from types import ModuleType
from typing import Any

import drake_formation
from building.roles import in_markdown

INTERNAL = {f"drake_formation.{name}" for name in ("cli", "places", "terminal")}
"""The command, which has a page of its own, how it writes folders, and what it says."""


def api_pages() -> dict[str, str]:
    """The page of every package that has a public API, by its name."""
    return {package.__name__: _page(package) for package in _packages()}


def _packages() -> list[ModuleType]:
    inner = walk_packages(drake_formation.__path__, f"{drake_formation.__name__}.")
    packages = [drake_formation, *(import_module(found.name) for found in inner if found.ispkg)]
    return [package for package in packages if hasattr(package, "__all__") and package.__name__ not in INTERNAL]


def _page(package: ModuleType) -> str:
    public = [f"::: {_place(package.__name__, member, getattr(package, member))}" for member in package.__all__]
    return "\n\n".join([f"# `{package.__name__}`", in_markdown(package.__doc__ or ""), *public]) + "\n"


def _place(package: str, member: str, value: Any) -> str:
    """What to look a member up by: where it is defined, if a module of its name hides it."""
    place = f"{package}.{member}"
    return f"{value.__module__}.{value.__qualname__}" if find_spec(place) else place
