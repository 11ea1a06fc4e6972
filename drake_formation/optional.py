"""Packages that this one does without, unless what needs them is asked for."""

import importlib
from types import ModuleType


class MissingPackageError(ImportError):
    """A package that is not installed, with the command that brings it."""


def required(module: str, extra: str) -> ModuleType:
    """A module of an optional dependency.

    Args:
        module: its name.
        extra: of this package, which brings it.

    Raises:
        MissingPackageError: it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        message = f"this needs {package}, which is not installed: pip install 'drake-formation[{extra}]' brings it"
        raise MissingPackageError(message) from error
