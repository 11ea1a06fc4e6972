"""The terminal: text that any locale can show, answers as people or programs read them, and orderly ways out."""

from drake_formation.terminal import letters as letters  # what a terminal lacks is spelt out from here on
from drake_formation.terminal.leaving import leaving_at_once, orderly
from drake_formation.terminal.manner import MANNER, detail
from drake_formation.terminal.saying import (
    FAILED_RUN,
    INTERRUPTED,
    PIPE_CLOSED,
    TERMINATED,
    WRONG_INPUT,
    Stopped,
    report,
    say,
    stop,
)

__all__ = [
    "FAILED_RUN",
    "INTERRUPTED",
    "MANNER",
    "PIPE_CLOSED",
    "TERMINATED",
    "WRONG_INPUT",
    "Stopped",
    "detail",
    "leaving_at_once",
    "orderly",
    "report",
    "say",
    "stop",
]
