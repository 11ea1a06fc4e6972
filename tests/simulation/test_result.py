import numpy as np
import pytest
import xarray as xr
from probe import context_at

from drake_formation import build_diagram, load_scenario, simulate
from drake_formation.scenario import resolve, with_overrides

UNITS = {
    "position": "m",
    "velocity": "m/s",
    "acceleration": "m/s²",
    "tracking_error": "m",
    "deviation": "m",
    "deviation_velocity": "m/s",
    "deviation_acceleration": "m/s²",
    "consensus_error": "m",
    "tracking_force": "N",
    "consensus_force": "N",
    "avoidance_force": "N",
    "control_force": "N",
    "spring_force": "N",
    "spring_length": "m",
    "rest_length": "m",
    "clearance": "m",
    "phase": "1",
    "slot": "m",
    "goal": "m",
    "aggregation_centre": "m",
    "obstacle_position": "m",
    "obstacle_radius": "m",
    "event_place": "m",
}


@pytest.fixture(scope="module")
def scenario():
    """A short run that passes an obstacle, with everything switched on."""
    return load_scenario(
        "quadrilateral",
        overrides={
            "aggregation.duration": 3.0,
            "transport.duration": 4.0,
            "springs.stiffness": [10.0, 20.0, 30.0, 40.0, 50.0, 60.0],
            "consensus.delta": 50.0,
            "consensus.delta_v": 5.0,
            "avoidance.obstacles": [{"position": [3.5, 4.5], "radius": 0.1}, {"position": [20.0, 1.9]}],
            "simulator.start_time": 2.0,
        },
    )


@pytest.fixture(scope="module")
def result(scenario):
    return simulate(scenario, engine="blocks")


def test_every_variable_has_a_unit_and_a_name(result):
    assert {name: variable.attrs["units"] for name, variable in result.data_vars.items()} == UNITS
    assert result["time"].attrs["units"] == "s"
    assert all(variable.attrs["long_name"] for variable in result.variables.values() if "units" in variable.attrs)


def test_axes_are_labelled(result):
    assert result["robot"].values.tolist() == [1, 2, 3, 4]
    assert result["axis"].values.tolist() == ["x", "y"]
    assert result["spring"].values.tolist() == ["1-2", "1-3", "1-4", "2-3", "2-4", "3-4"]
    assert result["obstacle"].values.tolist() == [1, 2]
    assert result["position"].dims == ("time", "robot", "axis")
    assert result["clearance"].dims == ("time", "robot", "obstacle")
    assert result["spring_length"].dims == ("time", "spring")


def test_time_increases_strictly_from_the_beginning_to_the_end(result):
    time = result["time"].values
    assert (np.diff(time) > 0).all()
    assert (time[0], time[-1]) == (2.0, 9.0)


def test_the_hand_off_is_a_sample_and_the_first_of_the_transport(result, scenario):
    assert result.attrs["hand_off_time_s"] == resolve(scenario).hand_off == 5.0
    transport = result["time"].values[result["phase"].values == 1]
    assert transport[0] == 5.0
    assert (result["phase"].values == (result["time"].values >= 5.0)).all()


def test_the_control_force_is_the_sum_of_its_parts(result):
    parts = result["tracking_force"] + result["consensus_force"] + result["avoidance_force"]
    np.testing.assert_array_equal(result["control_force"], parts)


def test_every_sample_shows_what_the_diagrams_ports_show_in_its_state(result, scenario):
    """In the transport, with a diagram of its own."""
    diagram = build_diagram(with_overrides(scenario, {"aggregation.duration": 0.0}))
    transport = result.isel(time=result["phase"].values == 1)
    centre = result["aggregation_centre"].values
    assert np.allclose(centre, resolve(scenario).centre)
    for index in range(0, transport.sizes["time"], 5):
        sample = transport.isel(time=index)
        context = context_at(diagram, np.hstack([sample["position"], sample["velocity"]]))
        for port in ("consensus_error", "control_force", "avoidance_force", "consensus_force"):
            shown = [diagram.GetOutputPort(f"robot_{i}_{port}").Eval(context) for i in (1, 2, 3, 4)]
            np.testing.assert_allclose(sample[port], shown, rtol=1e-12, atol=1e-12, err_msg=port)


def test_velocity_is_the_slope_of_position(result):
    position, velocity, time = (result[name].values for name in ("position", "velocity", "time"))
    mean = (velocity[1:] + velocity[:-1]) / 2
    np.testing.assert_allclose(np.diff(position, axis=0), mean * np.diff(time)[:, None, None], atol=1e-3)


def test_acceleration_is_the_slope_of_velocity(result):
    velocity, acceleration, time, phase = (
        result[name].values for name in ("velocity", "acceleration", "time", "phase")
    )
    within = phase[1:] == phase[:-1]  # at the hand-off it jumps
    mean = (acceleration[1:] + acceleration[:-1]) / 2 * np.diff(time)[:, None, None]
    np.testing.assert_allclose(np.diff(velocity, axis=0)[within], mean[within], atol=5e-3)


def test_the_rates_of_the_deviation_are_its_slopes(result):
    carried = result.isel(time=result["phase"].values == 1)
    deviation, rate, second, time = (
        carried[name].values for name in ("deviation", "deviation_velocity", "deviation_acceleration", "time")
    )
    step = np.diff(time)[:, None, None]
    np.testing.assert_allclose(np.diff(deviation, axis=0), (rate[1:] + rate[:-1]) / 2 * step, atol=1e-3)
    np.testing.assert_allclose(np.diff(rate, axis=0), (second[1:] + second[:-1]) / 2 * step, atol=1e-2)


def test_lengths_and_clearances_are_distances(result):
    position = result["position"]
    between = np.linalg.norm(position.sel(robot=2) - position.sel(robot=4), axis=-1)
    np.testing.assert_allclose(result["spring_length"].sel(spring="2-4"), between)
    assert result["rest_length"].sel(spring="2-4").item() == pytest.approx(np.sqrt(2))
    to_surface = np.linalg.norm(position.sel(robot=3) - [3.5, 4.5], axis=-1) - 0.1
    np.testing.assert_allclose(result["clearance"].sel(robot=3, obstacle=1), to_surface)


def test_the_deviation_begins_at_the_hand_off_with_zero(result):
    time, deviation = result["time"].values, result["deviation"].values
    assert np.isnan(deviation[time < 5.0]).all()
    assert np.isfinite(deviation[time >= 5.0]).all()
    np.testing.assert_array_equal(deviation[time == 5.0], 0)
    assert np.abs(deviation[time > 5.0]).max() > 1e-3


def test_the_deviation_is_from_the_same_run_without_obstacles(result, scenario):
    """At every sample, also between the samples of that run."""
    short_steps = {"avoidance.obstacles": [], "simulator.max_step_size": 5e-3}
    free = simulate(with_overrides(scenario, short_steps))["position"]
    transport = result.isel(time=result["phase"].values == 1)
    expected = transport["position"] - free.interp(time=transport["time"])
    np.testing.assert_allclose(transport["deviation"], expected, rtol=0, atol=2e-5)


@pytest.mark.parametrize("change", [{"avoidance.obstacles": []}, {"avoidance.gain": 0.0}])
def test_without_obstacles_there_is_no_deviation(scenario, change):
    result = simulate(with_overrides(scenario, change))
    transport = result["deviation"].values[result["phase"].values == 1]
    np.testing.assert_allclose(transport, 0, rtol=0, atol=1e-12)


def test_the_scenario_goes_with_the_result(result, scenario, tmp_path):
    (tmp_path / "again.yaml").write_text(result.attrs["scenario"], encoding="utf-8")
    assert load_scenario(tmp_path / "again.yaml") == scenario


def test_a_result_survives_a_file(result, tmp_path):
    result.to_netcdf(tmp_path / "result.nc")
    with xr.open_dataset(tmp_path / "result.nc") as again:
        xr.testing.assert_equal(again.load(), result)
