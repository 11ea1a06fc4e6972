import pytest

from drake_formation.parts import registry


@pytest.fixture
def parts_of_a_session():
    """Leave the parts there are as they were."""
    known = {role: dict(its) for role, its in registry._parts.items()}
    yield
    registry._parts.update(known)
    registry._told()
