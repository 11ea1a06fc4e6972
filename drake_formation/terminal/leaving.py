"""Ways out of a command that are a message and an exit status, whatever signal or stream asks for it."""

import codecs
import io
import locale
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import NoReturn

from drake_formation.terminal.saying import INTERRUPTED, Stopped, stop

_SIGNALS = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "terminated: the terminal was closed"}


@contextmanager
def orderly() -> Iterator[None]:
    """Streams that take any text, and signals that end the command with a message, for as long as it runs.

    A second signal ends it at once, whatever the first one is still waiting for.
    """
    _open_streams()
    _read_utf8()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="transliterate")
    asked: list[Stopped] = []

    def on_signal(number: int, _frame: FrameType | None) -> NoReturn:
        signal.signal(number, signal.SIG_DFL)
        asked.append(Stopped(_SIGNALS[signal.Signals(number).name], 128 + number))
        raise asked[0]

    try:
        with _handled(on_signal):
            yield
    except KeyboardInterrupt:
        stop(_SIGNALS["SIGINT"], INTERRUPTED)
    except BaseException as error:
        # On its way through C++ it may have become another exception.
        if isinstance(error, Stopped):
            asked.append(error)
        if asked and not isinstance(error, SystemExit):
            stop(asked[0].message, asked[0].status)
        raise


@contextmanager
def leaving_at_once() -> Iterator[None]:
    """Signals that end the process on the spot, while there is nothing to clean up: imports lose exceptions."""

    def on_signal(number: int, _frame: FrameType | None) -> NoReturn:
        os.write(2, f"{_SIGNALS[signal.Signals(number).name]}\n".encode())
        os._exit(128 + number)

    with _handled(on_signal):
        yield


@contextmanager
def _handled(handler: Callable[[int, FrameType | None], NoReturn]) -> Iterator[None]:
    former = {}
    for name in _SIGNALS:
        number = getattr(signal, name)
        if signal.getsignal(number) is not signal.SIG_IGN:  # as nohup has it
            former[number] = signal.signal(number, handler)
    try:
        yield
    finally:
        for number, earlier in former.items():
            signal.signal(number, earlier)


def _open_streams() -> None:
    """Give a stream that was closed the null device, lest a file that is opened later gets its number."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest number that is free: this one
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w" if number else "r", encoding="utf-8"))  # noqa: SIM115, PTH123


def _read_utf8() -> None:
    """Where the locale knows ASCII only, have files read as UTF-8: Drake's own cannot be imported otherwise."""
    if codecs.lookup(locale.getencoding()).name == "ascii":
        os.environ["PYTHONUTF8"] = "1"  # for the workers of a sweep
        with suppress(locale.Error):
            locale.setlocale(locale.LC_CTYPE, "C.UTF-8")
