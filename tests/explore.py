"""Try the laws on examples that no one has tried: rounds of all Hypothesis tests, each with a seed of its own.

``python tests/explore.py MINUTES [PYTEST ARGUMENTS]`` prints what was found with what repeats it, and ends with status
1 if anything was, or if there was no time for any law. A finding is mended and becomes an explicit ``@example`` of its
law.
"""

import contextlib
import io
import os
import random
import re
import secrets
import sys
import time
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
EXAMPLES = re.compile(r"(\d+) passing(?: examples)?, (\d+) failing")
SAID = r"(?:Falsifying|Failing) (?:example|test case)|You can reproduce"
REPEATING = re.compile(rf"^[E ]*(?:{SAID})[^\n]*(?:\n(?!\s*\n)[^\n]*)*", re.MULTILINE)


@dataclass(eq=False)  # pytest wants plugins to be hashable
class Round:
    """What one seed found; as a plugin of pytest it ends the round when the time is over."""

    seed: int
    end: float
    laws: int = 0
    examples: int = 0
    found: dict[str, str] = field(default_factory=dict)

    def pytest_collectreport(self, report):
        if report.failed:
            self.found[report.nodeid] = report.longreprtext

    def pytest_runtest_logreport(self, report):
        self.laws += report.when == "call"
        if report.failed:
            self.found[report.nodeid] = repeating(report.longreprtext)
        self.examples += sum(int(a) + int(b) for a, b in EXAMPLES.findall(getattr(report, "_hypothesis_stats", "")))
        if time.time() > self.end:
            pytest.exit("the time is over", returncode=0)


def repeating(text):
    """What repeats a failure, or all that is said of it."""
    return "\n".join(re.sub("^E  ", "", part, flags=re.MULTILINE) for part in REPEATING.findall(text)) or text


def one_round(seed, end, arguments):
    """All laws with a seed, in an order of its own since the last round is cut short; in a process of its own."""
    os.environ["HYPOTHESIS_PROFILE"] = "explore"
    this = Round(seed, end)
    places = arguments or files_of_laws(seed)
    options = ["-m", "hypothesis", "-p", "no:cacheprovider", "-p", "no:randomly", f"--hypothesis-seed={seed}"]
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        status = pytest.main([*options, *places], plugins=[this])
    if status not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED) and not this.found:
        this.found[f"pytest, status {int(status)}"] = said.getvalue()
    return this


def files_of_laws(seed):
    files = sorted(str(path) for path in TESTS.rglob("test_*.py") if "@given" in path.read_text(encoding="utf-8"))
    random.Random(seed).shuffle(files)
    return files


def rounds(minutes, arguments):
    """Rounds on all processors until the minutes are over, as they end."""
    end, processors = time.time() + 60 * minutes, os.cpu_count() or 1
    with ProcessPoolExecutor(processors, get_context("spawn"), max_tasks_per_child=1) as pool:
        running = set()
        while running or time.time() < end:
            while len(running) < processors and time.time() < end:
                running.add(pool.submit(one_round, secrets.randbelow(2**32), end, arguments))
            done, running = wait(running, return_when=FIRST_COMPLETED)
            yield from (each.result() for each in done)


def main():
    minutes, arguments = float(sys.argv[1]), sys.argv[2:]
    ended, found = [], set()
    for this in rounds(minutes, arguments):
        ended.append(this)
        for name in this.found.keys() - found:
            print(f"\n{name}\n{this.found[name]}", flush=True)
            print(f"(HYPOTHESIS_PROFILE=explore, --hypothesis-seed={this.seed})", flush=True)
        found |= this.found.keys()
    laws, examples = sum(each.laws for each in ended), sum(each.examples for each in ended)
    print(f"\n{len(ended)} rounds: laws tried {laws} times, on {examples} examples; {len(found)} found not to hold")
    for name in sorted(found):
        print(f"  {name}")
    return 1 if found or not laws else 0


if __name__ == "__main__":
    sys.exit(main())
