"""A worker process: reads chunks from standard input, runs them, writes reports to what was standard output."""

import os
import pickle
import queue
import sys
import threading
from typing import BinaryIO

from drake_formation.sweep.work import Chunk, run_chunk


def main() -> None:
    """Serve until standard input is closed."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever a library prints must not get between the reports
    chunks: queue.SimpleQueue[Chunk] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(sys.stdin.buffer, chunks), daemon=True).start()
    _answer(answers, True)
    while True:
        try:
            answer: object = run_chunk(chunks.get())
        except Exception as error:
            answer = error
        _answer(answers, answer)


def _answer(answers: BinaryIO, answer: object) -> None:
    pickle.dump(answer, answers)
    answers.flush()


def _listen(messages: BinaryIO, chunks: "queue.SimpleQueue[Chunk]") -> None:
    """Pass chunks on; leave at once when there is nobody to work for any more."""
    try:
        while True:
            chunks.put(pickle.load(messages))
    finally:
        os._exit(0)


if __name__ == "__main__":
    main()
