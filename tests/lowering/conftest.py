"""Compiled code of the tests is kept in a folder of their own, for one session."""

import pytest

from drake_formation import machine_code


@pytest.fixture(autouse=True, scope="session")
def _own_cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(machine_code.FOLDER, str(tmp_path_factory.mktemp("cache")))
        yield
