"""Why a sweep was not begun, or did not end."""


class SweepError(RuntimeError):
    """A sweep that cannot be carried out as asked, or not in that folder; runs that were finished before are kept."""


class SweepStoppedError(RuntimeError):
    """A sweep that could not go on. What was finished is kept; the same call goes on from there."""
