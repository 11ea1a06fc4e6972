"""Why a sweep was not begun, or did not end."""


class SweepError(RuntimeError):
    """A sweep that cannot be begun as asked; nothing was run."""


class SweepStoppedError(RuntimeError):
    """A sweep that could not go on. What was finished is kept; the same call goes on from there."""
