"""What the shell offers while a command is typed."""

import os
import subprocess
import sys

import pytest

from drake_formation.cli.completion import listed, names_of, override

TYPED = "import sys; sys.argv = ['drake-formation']; from drake_formation.__main__ import main; main()"


def offered(*words):
    """What a shell is told, and the modules that were imported for it."""
    environment = os.environ | {
        "_DRAKE_FORMATION_COMPLETE": "complete_bash",
        "COMP_WORDS": "\n".join(["drake-formation", *words]),
        "COMP_CWORD": str(len(words)),
    }
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-c", TYPED], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout.split(), done.stderr


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["ru"], ["run"]),
        (["run", "li"], ["line", "link-failure"]),
        (["sweep", "ga"], ["gains"]),
        (["compare", "avo"], ["avoidance"]),
        (["new", "mine", "--from", "oct"], ["octagon"]),
        (["list", "sw"], ["sweeps"]),
        (["list", "parts", "vir"], ["virtual_structure"]),
    ],
)
def test_a_shell_is_offered_names_without_importing_drake(words, expected):
    found, imported = offered(*words)
    assert found == expected
    assert "pydrake" not in imported


def test_metrics_are_offered():
    assert listed("metrics", "peak_f") == ["peak_force_n"]


def test_shipped_names_are_offered_by_kind():
    assert names_of("sweep")("") == ["bandwidth", "gains", "materials", "resilience", "starts", "topologies"]


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("spr", ["springs."]),
        ("springs.st", ["springs.stiffness="]),
        ("springs.law=", ["springs.law=hookean", "springs.law=linear"]),
        ("consensus.channel.kind=p", ["consensus.channel.kind=packets"]),
        ("consensus.channel.prof", ["consensus.channel.profile="]),
        ("simulator.use_error_control=t", ["simulator.use_error_control=true"]),
        ("transport.reference.kind=way", ["transport.reference.kind=waypoints"]),
        ("nothing.", []),
    ],
)
def test_paths_and_kinds_are_offered(typed, expected):
    assert override(typed) == expected
