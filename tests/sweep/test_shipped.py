"""Every shipped sweep runs: here in miniature, two positions of each axis and a fifth of a second."""

import pytest

from drake_formation.scenario.source import read
from drake_formation.sweep import load_sweep, run_sweep, shipped_sweeps


def miniature(name):
    """A shipped sweep's file as a mapping, made small."""
    data = dict(read(shipped_sweeps()[name]).data)
    data["set"] = data.get("set", {}) | {"aggregation.duration": 0.1, "transport.duration": 0.1}
    return data | {"axes": [shortened(axis) for axis in data["axes"]]}


def shortened(axis):
    """Two positions of an axis."""
    axis = dict(axis)
    for key in ("linspace", "logspace"):
        if key in axis:
            axis[key] = [*axis[key][:2], 2]
    if "count" in axis:
        axis["count"] = 2
    for key in ("labels", "points"):
        if key in axis:
            axis[key] = axis[key][:2]
    if axis.get("kind") == "zip":
        axis["values"] = {path: values[:2] for path, values in axis["values"].items()}
    elif "values" in axis:
        axis["values"] = axis["values"][:2]
    return axis


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped_sweeps())
def test_a_shipped_sweep_runs(tmp_path, name):
    with run_sweep(miniature(name), tmp_path, executor="serial") as dataset:
        assert dataset["status"].shape == (2,) * len(load_sweep(name).axes)
        assert (dataset["status"] == 1).all()
    assert any((tmp_path / "figures").glob("*.png"))
