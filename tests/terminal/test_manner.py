"""How much a command says."""

import logging

import pytest

from drake_formation.terminal.manner import LOG, Manner, detail


@pytest.fixture
def manner():
    made = Manner()
    yield made
    made.reset()


def test_details_are_told_where_they_are_asked_for(manner, capsys):
    detail("before")
    manner.go_into_details()
    manner.go_into_details()
    detail("what is done")
    logging.getLogger("drake_formation.anything").debug("why")
    out, err = capsys.readouterr()
    assert out == ""
    assert [line.partition("] ")[2] for line in err.splitlines()] == ["what is done"]


def test_the_next_command_begins_anew(manner):
    handlers = list(LOG.handlers)
    manner.go_into_details()
    manner.reset()
    assert LOG.handlers == handlers
    assert LOG.level == logging.NOTSET
