"""Metrics of a run are those of the motion, however far apart its samples are."""

import functools
import json

import numpy as np
import pytest
import xarray as xr
from carrying import UNLIKE, carried

from drake_formation import load_scenario, simulate
from drake_formation.measuring import Metrics, measure, metric, metrics, register, registry
from drake_formation.measuring.registry import MetricError
from drake_formation.simulation import PreparedRun
from drake_formation.vectors import length

SHORT = {"aggregation.duration": 5.0, "transport.duration": 15.0}
STEEL = {"aggregation.duration": 5.0, "transport.duration": 4.0, "springs.stiffness": 3e4}
STRONG = {"springs.stiffness": 3e4, "consensus.delta": 1e4}
QUICK = {"tracking.R": 0.01}  # it settles soon
NEAR = [{"position": [6.0, 5.05]}, {"position": [9.0, 2.4], "radius": 0.1}]
CASES = {
    "rubber": ("line", SHORT | QUICK),
    "steel": ("line", STEEL),
    "steel and consensus": ("line", {"aggregation.duration": 20.0, "transport.duration": 4.0} | STRONG),
    "near obstacles": ("line", SHORT | {"avoidance.obstacles": NEAR, "aggregation.duration": 0.0} | QUICK),
    "a nearest robot that senses": ("line", SHORT | {"avoidance.sensing": "nearest"} | QUICK),
    "a trajectory": ("s_curve", SHORT),
}
RINGING = {"steel", "steel and consensus"}


def sampled(result):
    """The metrics of a result by its samples alone."""
    carried = result.isel(time=result["phase"].values == 1)
    longest = {n: length(carried[n]).values for n in ("deviation", "consensus_error", "control_force")}
    strain = np.abs(carried["spring_length"] / carried["rest_length"] - 1).values
    way = float(length(carried["goal"] - carried["aggregation_centre"]))
    far = length(carried["position"] - carried["slot"] - carried["goal"]).max("robot").values > 0.02 * way
    since = carried["time"].values - carried["time"].values[0]
    return Metrics(
        tracking_error_m=longest["deviation"].max(axis=0).tolist(),
        consensus_error_m=float(longest["consensus_error"].max()),
        peak_force_n=float(longest["control_force"].max()),
        min_clearance_m=float(carried["clearance"].min()) if carried.sizes["obstacle"] else None,
        max_spring_strain=float(strain.max()) if strain.size else None,
        settling_time_s=None if far[-1] else float(since[np.flatnonzero(far)[-1] + 1]),
    )


@functools.cache
def truth(case):
    """The metrics of a far more accurate run, by samples that are 0.2 ms apart at the most."""
    name, overrides = CASES[case]
    fine = {"simulator.accuracy": 1e-10, "simulator.max_step_size": 2e-4}
    return sampled(simulate(load_scenario(name, overrides=overrides | fine), engine="compiled"))


def off(found, expected):
    """How far metrics are off in units of what they may be: micrometres, share of the force, a millisecond."""
    allowed = {
        "tracking_error_m": 2e-5,
        "consensus_error_m": 2e-6,
        "peak_force_n": 2e-5 * expected.peak_force_n,
        "min_clearance_m": 2e-6,
        "max_spring_strain": 5e-6,
        "settling_time_s": 1e-3,
    }
    pairs = {name: (found.to_dict()[name], value) for name, value in expected.to_dict().items()}
    assert all((mine is None) == (value is None) for mine, value in pairs.values())
    return {
        name: float(np.abs(np.subtract(mine, value)).max()) / allowed[name]
        for name, (mine, value) in pairs.items()
        if value is not None
    }


def run(case, engine, accuracy):
    name, overrides = CASES[case]
    return simulate(load_scenario(name, overrides=overrides | {"simulator.accuracy": accuracy}), engine=engine)


@pytest.mark.parametrize(
    ("case", "engine"),
    [(case, "compiled") for case in CASES] + [(case, "blocks") for case in CASES if case not in RINGING],
)
def test_metrics_are_those_of_the_motion(case, engine):
    result = run(case, engine, 1e-8)
    found = off(metrics(result), truth(case))
    assert max(found.values()) < 1, found
    assert max(off(sampled(result), truth(case)).values()) > 1, "its samples would have done: the test says nothing"


# Where the nearest robot alone senses, forces jump: the exponential engine refuses that.
@pytest.mark.parametrize("case", sorted(CASES.keys() - RINGING - {"a nearest robot that senses"}))
def test_the_exponential_engine_has_them_too(case):
    found = off(metrics(run(case, "exponential", 1e-8)), truth(case))
    assert max(found.values()) < 1, found


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["blocks", "compiled"])
@pytest.mark.parametrize("case", CASES)
def test_at_the_default_accuracy_what_is_left_is_the_runs_own_error(case, engine):
    found = off(metrics(run(case, engine, 1e-6)), truth(case))
    assert max(found.values()) < 30, found


def test_metrics_of_a_stored_result_are_those_of_the_run(tmp_path):
    scenario = load_scenario("quadrilateral", overrides={"aggregation.duration": 1.0, "transport.duration": 3.0})
    result = simulate(scenario, engine="compiled")
    result.to_netcdf(tmp_path / "result.nc")
    with xr.open_dataset(tmp_path / "result.nc") as stored:
        assert metrics(stored) == metrics(result)
    assert measure(PreparedRun(scenario, engine="compiled").run(scenario)) == metrics(result)


def line(**overrides):
    overrides = {"aggregation.duration": 2.0, "transport.duration": 3.0} | overrides
    return metrics(simulate(load_scenario("line", overrides=overrides), engine="blocks"))


def test_without_springs_or_obstacles_there_is_nothing_to_measure():
    measured = line(**{"springs.graph": [], "avoidance.obstacles": []})
    assert measured.max_spring_strain is None
    assert measured.min_clearance_m is None
    assert measured.tracking_error_m == [0, 0]


def test_a_run_that_ends_far_from_the_goal_has_not_settled():
    assert line().settling_time_s is None


def test_a_formation_that_is_carried_nowhere_settles_within_a_millimetre():
    gathered = {"robots.start": {"centre": [1.0, 2.0]}, "transport.goal": [1.0, 2.0], "avoidance.obstacles": []}
    assert line(**gathered).settling_time_s == 0
    displaced = gathered | {"robots.start": [[1.0, 1.4], [1.0, 2.6]], "aggregation.duration": 0.0}
    quick = {"tracking.R": 0.01, "transport.duration": 30.0, "springs.stiffness": 0.0}
    scenario = load_scenario("line", overrides=displaced | quick)
    result = simulate(scenario, engine="compiled")
    settled = metrics(result).settling_time_s
    off_slot = length(result["position"] - result["slot"] - result["goal"]).max("robot")
    assert 1 < settled < 30
    assert float(off_slot.interp(time=settled)) == pytest.approx(1e-3, rel=0.02)


DURATIONS = [0.0, 1e-300, 1e-15, 1e-9]


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
@pytest.mark.parametrize("start", [0.0, 1e9])
@pytest.mark.parametrize("transport", DURATIONS[1:])
@pytest.mark.parametrize("aggregation", DURATIONS)
def test_a_transport_of_no_time_at_all_has_its_first_sample(engine, start, aggregation, transport):
    overrides = {"simulator.start_time": start, "transport.duration": transport, "aggregation.duration": aggregation}
    result = simulate(load_scenario("line", overrides=overrides), engine=engine)
    measured = metrics(result)
    assert measured.tracking_error_m == pytest.approx([0, 0])
    assert measured.peak_force_n == pytest.approx(24.083189, rel=1e-6)


def test_a_result_without_transport_cannot_be_measured():
    result = simulate(load_scenario("line", overrides={"aggregation.duration": 1.0, "transport.duration": 1.0}))
    with pytest.raises(ValueError, match="no transport"):
        metrics(result.isel(time=result["phase"].values == 0))


def test_what_is_not_a_result_is_said_to_be_none():
    with pytest.raises(ValueError, match=r"not a result of this version: it has no velocity, .*scenario"):
        metrics(xr.Dataset({"position": ("time", [0.0])}))


def test_metrics_are_plain_numbers():
    measured = line()
    assert Metrics(**json.loads(json.dumps(measured.to_dict()))) == measured


def test_length_keeps_units():
    vector = xr.DataArray([[3.0, 4.0]], dims=("time", "axis"), attrs={"units": "m"})
    assert length(vector).values.tolist() == [5.0]
    assert length(vector).attrs == {"units": "m"}


@pytest.fixture
def own_registry(monkeypatch):
    monkeypatch.setattr(registry, "_metrics", registry.known())


def last(law, **settings):
    return register(metric("last_x_m", label="where x ends", unit="m", **settings)(law))


QUICK_RUN = {"aggregation.duration": 0.5, "transport.duration": 0.5}


@pytest.mark.usefixtures("own_registry")
def test_a_session_may_bring_its_own_and_replace_it():
    result = simulate(load_scenario("line", overrides=QUICK_RUN))
    last(lambda transport: transport["position"][-1, :, 0], each=True)
    assert metrics(result).last_x_m == result["position"].values[-1, :, 0].tolist()
    last(lambda transport: transport["position"][-1, 0, 0])
    assert metrics(result).last_x_m == float(result["position"].values[-1, 0, 0])


@pytest.mark.usefixtures("own_registry")
@pytest.mark.parametrize(
    ("law", "reason"),
    [
        (lambda transport: transport["positron"], "KeyError: 'positron'"),
        (lambda transport: [1.0, 2.0], r"ValueError: its values have the shape \(2,\) instead of \(\)"),
    ],
)
def test_a_mistake_in_another_packages_metric_costs_its_own_figure_alone(law, reason):
    result = simulate(load_scenario("line", overrides=QUICK_RUN))
    last(law)
    with pytest.warns(UserWarning, match=rf"metric 'last_x_m' of this session cannot be measured: {reason}"):
        measured = metrics(result)
    assert measured.last_x_m is None
    assert measured.consensus_error_m is not None


def test_what_is_no_metric_or_has_a_name_that_is_taken_is_refused():
    with pytest.raises(MetricError, match="'law' of this session is no metric"):

        @register
        def law(_transport):
            return 1.0

    with pytest.raises(MetricError, match="drake-formation has a metric 'peak_force_n'; give yours another name"):
        register(metric("peak_force_n", label="mine", unit="N")(lambda transport: 0.0))
    with pytest.raises(AttributeError, match="there is no metric 'speed'"):
        Metrics(peak_force_n=1.0).speed  # noqa: B018


@pytest.mark.parametrize("case", ["rubber", "steel and consensus", "a trajectory"])
def test_effort_is_that_of_a_far_finer_run(case):
    """Integrals over the integrator's steps, beside sums over samples 0.2 ms apart at the most."""
    name, overrides = CASES[case]
    fine = {"simulator.accuracy": 1e-10, "simulator.max_step_size": 2e-4}
    result = simulate(load_scenario(name, overrides=overrides | fine), engine="compiled")
    carried = result.isel(time=result["phase"].values == 1)
    times, force, velocity = (carried[name].values for name in ("time", "control_force", "velocity"))
    mean_square = np.trapezoid((force**2).sum(axis=-1).mean(axis=-1), times) / (times[-1] - times[0])
    work = np.trapezoid(abs((force * velocity).sum(axis=-1)).sum(axis=-1), times)
    found = metrics(simulate(load_scenario(name, overrides=overrides), engine="compiled"))
    assert found.rms_force_n == pytest.approx(np.sqrt(mean_square), rel=2e-3)
    assert found.energy_j == pytest.approx(work, rel=2e-3)


def test_an_object_that_is_a_body_of_its_own_has_a_strain():
    result = simulate(carried("{kind: rigid}", **UNLIKE))
    strain = result["object_strain"].values[result["phase"].values == 1]
    assert metrics(result).max_object_strain == strain.max() > 0
    assert metrics(result).max_spring_strain is None
    assert metrics(simulate(load_scenario("line", overrides=QUICK_RUN))).max_object_strain is None
