import pytest
from sweep.quick import quick_sweep

from drake_formation.sweep import load_sweep


@pytest.fixture
def sweep():
    """Twelve quick points over two axes."""
    return load_sweep(quick_sweep())
