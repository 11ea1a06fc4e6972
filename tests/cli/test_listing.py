"""What there is is listed with a sentence each, and by its former names for a while."""

import json

import pytest

from drake_formation.measuring.registry import known
from drake_formation.parts.registry import kinds
from drake_formation.parts.roles import ROLES
from drake_formation.shipped import shipped

NAMES = {
    "scenarios": shipped("scenario"),
    "sweeps": shipped("sweep"),
    "comparisons": shipped("comparison"),
    "parts": [kind for role in ROLES for kind in kinds(role)],
    "metrics": known(),
}


@pytest.mark.parametrize("what", NAMES)
def test_all_there_is_has_a_sentence(cli, what):
    rows = json.loads(cli("list", what, "--json")[1])[what]
    assert [row["kind" if what == "parts" else "name"] for row in rows] == list(NAMES[what])
    sentence = "what it is" if what in ("parts", "metrics") else "what it shows"
    assert all(" " in row[sentence] for row in rows)


@pytest.mark.parametrize("what", NAMES)
def test_in_short_there_are_the_names(cli, what):
    assert cli("list", what, "-q")[1].split() == list(dict.fromkeys(NAMES[what]))


def test_some_may_be_asked_for(cli):
    _, out, _ = cli("list", "parts", "kalman", "mpc")
    assert [line.split()[0] for line in out.splitlines()[1:]] == ["mpc", "kalman"]


def test_one_that_is_not_there_is_refused_with_the_nearest(cli):
    status, _, err = cli("list", "metrics", "peak_frce_n")
    assert status == 2
    assert "did you mean 'peak_force_n'" in err


@pytest.mark.parametrize("what", ["scenarios", "parts", "metrics"])
def test_the_former_commands_work_and_say_that_they_go(cli, what):
    _, now, _ = cli("list", what)
    status, out, err = cli(what)
    assert (status, out) == (0, now)
    assert (
        err == f"drake-formation {what} is deprecated since 0.1 and goes with 0.2: use drake-formation list {what}.\n"
    )
    assert f"  {what} " not in cli("--help")[1]
