"""Why a result cannot be written as asked for."""


class ExportError(ValueError):
    """A result that has not what is to be written."""
