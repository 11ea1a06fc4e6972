"""What can be wrong with a picture that moves, beside the result that it shows."""


class FilmError(ValueError):
    """A film that cannot be written, and why."""


class PortError(OSError):
    """A port of this machine at which nothing can be served."""
