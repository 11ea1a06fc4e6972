"""How a command speaks: how much, and to whom."""

import logging
import sys
import time
from contextlib import suppress
from dataclasses import dataclass

LOG = logging.getLogger("drake_formation")


@dataclass
class Manner:
    """What was asked for of this run of the command.

    Attributes:
        as_json: one JSON document instead of what people read.
        quiet: errors alone, and the bare answer of what was asked.
        at_length: say on standard error what is done when.
    """

    as_json: bool = False
    quiet: bool = False
    at_length: bool = False

    def reset(self) -> None:
        """As at the beginning of a command."""
        self.as_json, self.quiet, self.at_length = False, False, False
        for handler in [handler for handler in LOG.handlers if isinstance(handler, _Told)]:
            LOG.removeHandler(handler)
        LOG.setLevel(logging.NOTSET)

    def go_into_details(self) -> None:
        """Let what the package logs, from level INFO on, be said on standard error."""
        if not self.at_length:
            self.at_length = True
            LOG.addHandler(_Told())
            LOG.setLevel(logging.INFO)

    @property
    def shows_progress(self) -> bool:
        """Whether bars may move on standard error, if that is a terminal."""
        return not (self.quiet or self.as_json)


class _Told(logging.Handler):
    """Lines on standard error, each with the time since the command began (s)."""

    def __init__(self) -> None:
        super().__init__()
        self._begin = time.monotonic()

    def emit(self, record: logging.LogRecord) -> None:
        with suppress(OSError):  # nobody may be listening any more
            print(f"[{time.monotonic() - self._begin:7.3f} s] {record.getMessage()}", file=sys.stderr, flush=True)


def detail(text: str) -> None:
    """Say what is done, where ``-v`` asks for it."""
    LOG.info(text)


MANNER = Manner()
"""Of the command that runs; there is one a process."""
