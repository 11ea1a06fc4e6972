import pytest

from drake_formation.sweep.errors import SweepError
from drake_formation.sweep.executors import Serial, choose
from drake_formation.sweep.processes import Processes


def test_executors_by_name():
    assert isinstance(choose("serial", None, None), Serial)
    with choose("processes", 3, None) as three:
        assert isinstance(three, Processes)
        assert three.slots == 3
    with choose("processes", None, None) as all_processors:
        assert all_processors.slots >= 1


@pytest.mark.parametrize(
    ("name", "workers", "message"),
    [
        ("threads", None, "there are serial, processes"),
        ("processes", 0, "at least one"),
        ("processes", 10**6, "at most 1024"),
    ],
)
def test_what_there_is_not_is_refused(name, workers, message):
    with pytest.raises(SweepError, match=message):
        choose(name, workers, None)
