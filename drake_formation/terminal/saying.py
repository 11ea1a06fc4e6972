"""What a command says: answers on standard output, as people or programs read them, and why it ends on the other."""

import json
import os
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NoReturn

from drake_formation.terminal.manner import MANNER

if TYPE_CHECKING:
    from rich.console import RenderableType

WRONG_INPUT, FAILED_RUN, INTERRUPTED, PIPE_CLOSED, TERMINATED = 2, 3, 130, 141, 143
"""Exit statuses beside 0; the last three are the shell's for a process ended by SIGINT, SIGPIPE and SIGTERM."""


class Stopped(BaseException):
    """A command that is to end now; like KeyboardInterrupt, nothing that handles errors is to catch it.

    Attributes:
        message: what to say; empty for nothing.
        status: the exit status.
    """

    def __init__(self, message: str, status: int) -> None:
        super().__init__(message)
        self.message = message
        self.status = status


def stop(message: str, status: int, faults: Sequence[Mapping[str, Any]] = ()) -> NoReturn:
    """Say what is wrong on standard error, and leave.

    Args:
        message: plain text; as JSON it is part of an object ``error``.
        status: the exit status.
        faults: what is wrong one by one, which JSON has too.
    """
    with suppress(OSError):  # nobody may be listening any more
        if message and MANNER.as_json:
            error = {"status": status, "message": message, "faults": [dict(fault) for fault in faults]}
            print(_json({"error": error}), file=sys.stderr, flush=True)
        elif message:
            print(message, file=sys.stderr, flush=True)
    raise SystemExit(status)


def report(document: Mapping[str, Any], *shown: "RenderableType", short: str = "") -> None:
    """Answer what was asked, in the manner that was asked for.

    Args:
        document: the answer for programs: mappings, lists, texts and numbers; what is not finite becomes null.
        shown: the same for people, one after the other.
        short: what is left of that for ``--quiet``; empty where the exit status or the files say it all.

    Raises:
        Stopped: as for :func:`say`.
    """
    if MANNER.as_json:
        say(_json(document))
    elif not MANNER.quiet:
        for part in shown:
            say(part)
    elif short:
        say(short)


def say(what: "RenderableType") -> None:
    """Print something to standard output.

    Raises:
        Stopped: it cannot be written: its reader has gone, or a disk is full.
    """
    try:
        if isinstance(what, str):
            print(what)
        else:
            from drake_formation.terminal.tables import console  # slow to import

            console().print(what)
        sys.stdout.flush()
    except OSError as error:
        with suppress(OSError, ValueError):  # Python would try once more, and complain, when it ends
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            raise Stopped("", PIPE_CLOSED) from error
        raise Stopped(f"standard output: cannot be written: {error.strerror}", WRONG_INPUT) from error


def _json(document: Any) -> str:
    return json.dumps(_finite(document), indent=2, ensure_ascii=False, allow_nan=False, default=str)


def _finite(value: Any) -> Any:
    """As JSON has it, which knows neither NaN nor infinities."""
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    return value
