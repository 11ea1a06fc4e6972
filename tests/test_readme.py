"""The README's Python example does what it says."""

import re
from pathlib import Path

from drake_formation.compare import load_comparison
from drake_formation.parts import kinds
from drake_formation.parts.roles import ROLES

README = Path(__file__).parents[1] / "README.md"


def test_python_example_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert len([line for line in example.splitlines() if line]) == 5
    exec(compile(example, str(README), "exec"), {})
    assert "consensus_error_m=0.09" in capsys.readouterr().out


def test_every_part_has_its_line_in_the_table():
    text = README.read_text(encoding="utf-8")
    table = text.split("## Parts")[1].split("## ")[0]
    for role in ROLES:
        for kind, part in kinds(role).items():
            if part.distribution == "drake-formation":
                assert f"`{kind}`" in table, (role, kind)


def test_the_table_of_laws_has_the_shipped_comparisons_laws():
    text = README.read_text(encoding="utf-8")
    (table,) = re.findall(r"<!-- coordination -->\n(.*?)<!-- /coordination -->", text, re.DOTALL)
    comparison = load_comparison("coordination")
    for case in comparison.cases:
        rows = table.split(f"**{case}**")[1].split("\n\n")[1]
        assert [line.split(" | ")[0].removeprefix("| ") for line in rows.splitlines()[2:]] == list(comparison.laws)


def test_the_shell_commands_are_commands():
    from drake_formation.cli import app

    text = README.read_text(encoding="utf-8")
    known = {command.name or command.callback.__name__: command.hidden for command in app.registered_commands}
    used = set(re.findall(r"^drake-formation ([a-z]\S*)", text, re.MULTILINE))
    assert used <= {name for name, hidden in known.items() if not hidden}
    assert {"run", "new", "show", "list", "validate"} <= used
