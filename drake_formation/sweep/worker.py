"""A worker process: reads calls from standard input, carries them out, answers on what was standard output."""

import os
import pickle
import queue
import sys
import threading
from collections.abc import Callable
from typing import Any, BinaryIO

Call = tuple[Callable[..., Any], tuple[Any, ...]]
"""A function, which the worker imports by its name, and its arguments."""


def main() -> None:
    """Serve until standard input is closed, or nobody reads the answers: without a word, whatever was under way."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever a library prints must not get between the reports
    calls: queue.SimpleQueue[Call] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, calls), daemon=True).start()
    _answer(answers, True)
    while True:
        function, arguments = calls.get()
        try:
            answer: object = function(*arguments)
        except Exception as error:
            answer = error
        _answer(answers, answer)


def _answer(answers: BinaryIO, answer: object) -> None:
    try:
        message = pickle.dumps(answer)
    except Exception as error:
        message = pickle.dumps(RuntimeError(f"the answer cannot be sent: {error}; it was {answer!r}"))
    try:
        answers.write(message)
        answers.flush()
    except OSError:
        os._exit(0)


def _listen(messages: BinaryIO, calls: "queue.SimpleQueue[Call]") -> None:
    """Pass calls on; leave at once when there is nobody to work for any more."""
    try:
        while True:
            calls.put(pickle.load(messages))
    finally:
        os._exit(0)


if __name__ == "__main__":
    main()
