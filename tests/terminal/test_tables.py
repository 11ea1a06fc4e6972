"""Tables on a terminal and off it."""

import os
import pty
import string
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.terminal.tables import console


@given(st.text(string.ascii_letters + string.punctuation + " δ"))
def test_tables_take_texts_as_they_are(text):
    assert console().render_str(text).plain == text


SHOWN = """
from drake_formation.terminal import say
from drake_formation.terminal.tables import heading, table
made = table("name", "what it is", title="some")
made.add_row("[bold]", "δ " * 60)
say(heading("above"))
say(made)
"""


def on_a_terminal(**settings):
    """What comes out of SHOWN on a terminal of 80 columns."""
    ours, its = pty.openpty()
    environment = {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "FORCE_COLOR")}
    environment |= {"TERM": "xterm", "COLUMNS": "80"} | settings
    done = subprocess.Popen([sys.executable, "-c", SHOWN], stdout=its, env=environment)
    os.close(its)
    shown = b""
    try:
        while piece := os.read(ours, 4096):
            shown += piece
    except OSError:  # its other side is closed
        pass
    os.close(ours)
    assert done.wait() == 0
    return shown.decode()


def test_a_terminal_gets_boxes_and_styles():
    shown = on_a_terminal()
    assert "┃" in shown
    assert "\x1b[" in shown


@pytest.mark.parametrize(("setting", "boxes"), [({"NO_COLOR": "1"}, True), ({"TERM": "dumb"}, False)])
def test_a_terminal_may_ask_for_less(setting, boxes):
    shown = on_a_terminal(**setting)
    assert "\x1b" not in shown
    assert ("┃" in shown) == boxes


def test_what_is_piped_has_one_line_a_row_and_nothing_but_text():
    done = subprocess.run([sys.executable, "-c", SHOWN], capture_output=True, check=True)
    lines = done.stdout.decode().splitlines()
    assert lines == ["above", "some", "name    what it is", "[bold]  " + ("δ " * 60).rstrip()]
