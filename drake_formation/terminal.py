"""The terminal: text that any locale can show, and ways out of a command that are a message and an exit status."""

import codecs
import functools
import io
import locale
import os
import signal
import sys
import unicodedata
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.text import Text

WRONG_INPUT, FAILED_RUN, INTERRUPTED, PIPE_CLOSED, TERMINATED = 2, 3, 130, 141, 143
"""Exit statuses beside 0; the last three are the shell's for a process ended by SIGINT, SIGPIPE and SIGTERM."""

_SIGNALS = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "terminated: the terminal was closed"}

_ASCII = {
    "≤": "<=", "≥": ">=", "≠": "!=", "≈": "~", "−": "-", "–": "-", "—": "-", "×": "x", "·": ".", "√": "sqrt", "‖": "||",
    "∞": "inf", "→": "->", "←": "<-", "±": "+/-", "…": "...", "“": '"', "”": '"', "‘": "'", "’": "'", "°": " deg",
    "∈": "in", "µ": "u", "¹": "^1", "²": "^2", "³": "^3", "⁻": "^-", "─": "-", "━": "-", "│": "|", "┃": "|",
}  # fmt: skip
"""ASCII for what this package prints, beside Greek letters, which become their names, and accents, which go."""


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


def stop(message: str, status: int) -> NoReturn:
    """Say what is wrong, as plain text on standard error, and leave."""
    with suppress(OSError):  # nobody may be listening any more
        if message:
            print(message, file=sys.stderr, flush=True)
    raise SystemExit(status)


def say(what: "RenderableType") -> None:
    """Print something to standard output.

    Raises:
        Stopped: it cannot be written: its reader has gone, or a disk is full.
    """
    try:
        if isinstance(what, str):
            print(what)
        else:
            console().print(what)
        sys.stdout.flush()
    except OSError as error:
        with suppress(OSError, ValueError):  # Python would try once more, and complain, when it ends
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if isinstance(error, BrokenPipeError):
            raise Stopped("", PIPE_CLOSED) from error
        raise Stopped(f"standard output: cannot be written: {error.strerror}", WRONG_INPUT) from error


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


def _transliterated(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_in_ascii, error.object[error.start : error.end])), error.end


def _in_ascii(character: str) -> str:
    if character in _ASCII:
        return _ASCII[character]
    words = unicodedata.name(character, "").split()
    if words[:1] == ["GREEK"] and words[2:3] == ["LETTER"]:
        return words[3].lower() if words[1] == "SMALL" else words[3].capitalize()
    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return plain or character.encode("ascii", "backslashreplace").decode()


@functools.cache
def console() -> "Console":
    """Standard output for tables: it takes texts as they are, brackets and colons too."""
    from rich.console import Console  # slow to import

    class OwnConsole(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError  # for `say`; by itself rich would leave with status 1

        def render_str(self, text: str, **options: Any) -> "Text":
            # Before a table is laid out, so that its columns stand straight.
            return super().render_str(text.encode(self.encoding, "transliterate").decode(self.encoding), **options)

    return OwnConsole(markup=False, emoji=False)


codecs.register_error("transliterate", _transliterated)
