"""The README's Python example does what it says."""

import re
from pathlib import Path

README = Path(__file__).parents[1] / "README.md"


def test_python_example_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert len([line for line in example.splitlines() if line]) == 5
    exec(compile(example, str(README), "exec"), {})
    assert "consensus_error_m=0.09" in capsys.readouterr().out
