"""One tidy table of a result, and the same as CSV."""

import numpy as np
import pandas as pd
import pytest
from short_runs import lossy, short

from drake_formation.exporting.errors import ExportError


def test_every_time_and_robot_has_a_row_with_its_own_numbers():
    result = short()
    frame = result.formation.to_dataframe()
    assert frame.index.names == ["time", "robot"]
    assert len(frame) == result.sizes["time"] * result.sizes["robot"]
    for robot in (1, 2):
        own = frame.xs(robot, level="robot")
        assert np.array_equal(own["position_y"], result["position"].sel(robot=robot, axis="y"))
        clearance = result["clearance"].sel(robot=robot, obstacle=2)
        assert np.array_equal(own["clearance_obstacle_2"], clearance)
        assert np.array_equal(own["phase"], result["phase"])
        assert (own["slot_x"] == float(result["slot"].sel(robot=robot, axis="x"))).all()
    assert not any("spring_length" in column for column in frame)
    assert set(frame.attrs["units"]) == {"time", *frame.columns}
    assert frame.attrs["units"]["velocity_x"] == "m/s"


def test_springs_channels_and_time_have_tables_of_their_own():
    result = lossy()
    springs = result.formation.to_dataframe("spring")
    assert np.array_equal(springs["spring_length"].xs("1-2", level="spring"), result["spring_length"][:, 0])
    channels = result.formation.to_dataframe("channel")
    assert channels["traffic_sent"].max() > 0
    assert channels.attrs["units"]["traffic_sent_at"] == "s"
    assert list(result.formation.to_dataframe("time").columns) == ["phase"]


def test_what_a_result_has_no_rows_of_is_refused():
    with pytest.raises(ExportError, match="no rows of 'node'; it has those of time, robot, spring, obstacle"):
        short().formation.to_dataframe("node")


def test_a_csv_reads_back_bit_for_bit(tmp_path):
    result = short()
    result.formation.to_csv(tmp_path / "run.csv")
    read = pd.read_csv(tmp_path / "run.csv")
    frame = result.formation.to_dataframe()
    assert list(read.columns[:3]) == ["time (s)", "robot", "position_x (m)"]
    assert "phase" in read
    assert np.array_equal(read["control_force_x (N)"], frame["control_force_x"])
    assert np.array_equal(read["time (s)"], frame.index.get_level_values("time"))
