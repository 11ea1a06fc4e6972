"""Laws are tried on the same examples whatever ran before, in every process; another profile draws new ones."""

import os
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).parent

DRAWN = """
import sys
from examples import load_profile
load_profile()
from hypothesis import given, settings, strategies as st
import strategies
sys.path.insert(0, sys.argv[1])
{imported}

@given(st.tuples(*[st.floats(0, 1e6)] * 20), st.sampled_from(sorted({{"a", "b"}})), strategies.scenarios())
@settings(max_examples=30)
def law(numbers, letter, scenario):
    print(numbers, letter, scenario)

law()
"""


def drawn(folder, imported="", **environment):
    """What a process of its own draws."""
    named = {"PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent)])} | environment
    inherited = {name: value for name, value in os.environ.items() if name != "HYPOTHESIS_PROFILE"}
    # A file, since Hypothesis seeds with the source of the function.
    script = folder / "law.py"
    script.write_text(DRAWN.format(imported=imported), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, script, folder], env=inherited | named, cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout


def test_examples_are_the_same_in_every_process(tmp_path):
    (tmp_path / "numbers_of_mine.py").write_text(f"NUMBERS = {[k + 0.123 for k in range(200)]}", encoding="utf-8")
    first = drawn(tmp_path, PYTHONHASHSEED="1")
    assert first.count("\n") == 30
    assert drawn(tmp_path, "import numbers_of_mine", PYTHONHASHSEED="2") == first


def test_exploring_draws_new_ones(tmp_path):
    first, second = (drawn(tmp_path, HYPOTHESIS_PROFILE="explore") for _ in range(2))
    assert first != second
