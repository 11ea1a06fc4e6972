"""What Rerun opens is the result; tried where Rerun is installed, which is large."""

import numpy as np
import pytest
from short_runs import short

from drake_formation.optional import MissingPackageError


def test_a_recording_has_what_is_seen_and_every_number(tmp_path):
    chunk = pytest.importorskip("rerun.chunk", reason="pip install 'drake-formation[rerun]'")
    result = short()
    result.formation.to_rrd(tmp_path / "run.rrd")
    found = {}
    for part in chunk.RrdReader(tmp_path / "run.rrd").stream():
        found.setdefault(str(part.entity_path), []).append(part)
    assert {"/world/robot_1/robot_1/part_0", "/world/obstacle_2/part_0", "/world/springs", "/world/path_2"} <= set(
        found
    )
    assert found["/world/robot_1/robot_1/part_0"][0].is_static
    batches = [part.to_record_batch() for part in found["/robot_2/control_force_x"]]
    forces = np.concatenate([np.concatenate(batch["Scalars:scalars"].to_pylist()) for batch in batches])
    assert np.array_equal(forces, result["control_force"].sel(robot=2, axis="x"))
    (moving,) = (part.to_record_batch() for part in found["/world/robot_2"])
    places = np.concatenate(moving["Transform3D:translation"].to_pylist())
    assert places[-1, :2] == pytest.approx(result["position"].values[-1, 1], abs=1e-6)  # Rerun's places are floats


def test_a_missing_package_is_named_with_what_brings_it(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "rerun", None)
    with pytest.raises(MissingPackageError, match=r"pip install 'drake-formation\[rerun\]'"):
        short().formation.to_rrd(tmp_path / "run.rrd")
