"""``python -m fuzz``: mutated commands for some minutes, or some number of them, and what came of each kind."""

import argparse
import shlex
import sys
import time
from collections import Counter
from itertools import islice

from fuzz.mutations import cases
from fuzz.running import FAILED, FAULTS, RAN, REFUSED, carry_out, warm_up


def main() -> None:
    """Run it; the exit status is 1 if anything but a message, a status and a result was seen."""
    parser = argparse.ArgumentParser(prog="python -m fuzz", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, help="how long; or")
    parser.add_argument("--count", type=int, default=None, help="how many")
    arguments = parser.parse_args()
    warm_up()
    end = time.monotonic() + 60 * arguments.minutes if arguments.minutes else float("inf")
    counts: Counter[str] = Counter()
    for number, case in enumerate(islice(cases(arguments.seed), arguments.count if not arguments.minutes else None)):
        if time.monotonic() > end:
            break
        outcome = carry_out(case)
        counts[outcome.verdict] += 1
        if outcome.verdict in FAULTS:
            print(f"\n== {outcome.verdict}, case {number} of seed {arguments.seed}, status {outcome.status}")
            print(shlex.join(["drake-formation", *case.arguments]))
            print(*(f"{name}: {text}" for name, text in case.files.items()), sep="\n")
            print(outcome.output[-3000:], flush=True)
    print(", ".join(f"{counts[kind]} {kind}" for kind in (REFUSED, RAN, FAILED, *FAULTS)), f"of {counts.total()} tried")
    sys.exit(any(counts[kind] for kind in FAULTS))


if __name__ == "__main__":
    main()
