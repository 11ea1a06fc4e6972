"""Commands end in good order."""

import pytest

from drake_formation.terminal import Stopped, orderly


def test_being_stopped_is_a_message_and_a_status(capsys):
    with pytest.raises(SystemExit) as end, orderly():
        raise Stopped("terminated", 143)
    assert end.value.code == 143
    assert capsys.readouterr() == ("", "terminated\n")
