"""What goes: it still works for one minor version, which warns of it, and is gone with the next.

Version numbers are semantic; what they promise is in ``docs/versions.md``.
"""

import warnings
from dataclasses import dataclass


@dataclass(frozen=True)
class Deprecation:
    """Something that goes.

    Attributes:
        what: as users know it, such as ``drake-formation parts``.
        since: the minor version that warns first, such as ``0.1``.
        instead: what to use, in an imperative sentence without its full stop.
    """

    what: str
    since: str
    instead: str

    @property
    def gone_in(self) -> str:
        """The minor version that does not have it any more."""
        major, minor = self.since.split(".")
        return f"{major}.{int(minor) + 1}"

    def __str__(self) -> str:
        """What to tell who uses it."""
        return f"{self.what} is deprecated since {self.since} and goes with {self.gone_in}: {self.instead}."

    def warn(self, stacklevel: int = 2) -> None:
        """Warn from Python.

        Args:
            stacklevel: as for :func:`warnings.warn`, whose 1 is the caller of this.
        """
        warnings.warn(str(self), DeprecationWarning, stacklevel=stacklevel + 1)


LISTS = tuple(
    Deprecation(f"drake-formation {what}", "0.1", f"use drake-formation list {what}")
    for what in ("scenarios", "parts", "metrics")
)

ALL = (*LISTS,)
"""All there are; a test fails where one has outlived its time."""
