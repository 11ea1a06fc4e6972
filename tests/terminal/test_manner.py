"""How much a command says."""

import logging

import pytest

from drake_formation.terminal.manner import LOG, Manner, detail


@pytest.fixture
def manner():
    made = Manner()
    yield made
    made.reset()


@pytest.mark.parametrize(("details", "told"), [(0, []), (1, ["what is done"]), (2, ["what is done", "why"])])
def test_details_are_told_as_far_as_asked_for(manner, capsys, details, told):
    manner.go_into_details(details)
    detail("what is done")
    logging.getLogger("drake_formation.anything").debug("why")
    out, err = capsys.readouterr()
    assert out == ""
    assert [line.partition("] ")[2] for line in err.splitlines()] == told


def test_asking_twice_tells_once(manner, capsys):
    manner.go_into_details(1)
    manner.go_into_details(2)
    detail("what is done")
    assert capsys.readouterr().err.count("what is done") == 1


def test_the_next_command_begins_anew(manner):
    handlers = list(LOG.handlers)
    manner.go_into_details(2)
    manner.reset()
    assert LOG.handlers == handlers
    assert LOG.level == logging.NOTSET
