"""Why a result cannot be written in a format."""

import importlib
from types import ModuleType


class ExportError(ValueError):
    """A result that cannot be written as asked for."""


def required(module: str, extra: str) -> ModuleType:
    """A module of an optional dependency.

    Args:
        module: its name.
        extra: of this package, which brings it.

    Raises:
        ExportError: it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        message = f"this needs {package}, which is not installed: pip install 'drake-formation[{extra}]' brings it"
        raise ExportError(message) from error
