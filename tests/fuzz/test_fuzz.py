"""Mutated commands, the same ones each time, end in a message, an exit status and a result."""

import shlex
from itertools import islice

import pytest

from fuzz.mutations import cases
from fuzz.running import FAULTS, carry_out, warm_up

CASES = 120


@pytest.mark.slow
def test_no_command_ends_in_a_traceback_or_never():
    warm_up()
    faults = []
    for case in islice(cases(1), CASES):
        outcome = carry_out(case)
        if outcome.verdict in FAULTS:
            faults.append(f"{outcome.verdict}: {shlex.join(case.arguments)}\n{case.files}\n{outcome.output[-2000:]}")
    assert not faults, "\n\n".join(faults)
