"""What MATLAB loads is the result, with its names and units."""

import numpy as np
from scipy.io import loadmat
from short_runs import short

from drake_formation import metrics


def test_a_mat_file_has_every_variable_by_its_name(tmp_path):
    result = short()
    result.formation.to_mat(tmp_path / "run.mat")
    file = loadmat(tmp_path / "run.mat", simplify_cells=True)
    assert [name for name in file if not name.startswith("__")] == ["result"]
    struct = file["result"]
    assert struct["position"].shape == result["position"].shape
    for name in ("time", "position", "control_force", "clearance", "deviation"):
        assert np.array_equal(struct[name], result[name], equal_nan=True)
    assert struct["phase"].dtype == float
    assert (struct["spring"], list(struct["axis"])) == ("1-2", ["x", "y"])
    assert struct["units"]["acceleration"] == "m/s²"
    assert list(struct["dimensions"]["position"]) == ["time", "robot", "axis"]
    assert struct["metrics"]["consensus_error_m"] == metrics(result).consensus_error_m
    assert struct["attributes"]["scenario"] == result.attrs["scenario"]
    assert all(name.isidentifier() and len(name) <= 63 for name in struct)


def test_a_run_that_ended_before_the_transport_has_no_metrics(tmp_path):
    result = short()
    result.isel(time=result["phase"].values == 0).formation.to_mat(tmp_path / "run.mat")
    assert len(loadmat(tmp_path / "run.mat", simplify_cells=True)["result"]["metrics"]) == 0
