"""What can be wrong with a picture that moves."""


class FilmError(ValueError):
    """A film that cannot be written, and why."""
