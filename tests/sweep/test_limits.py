"""What is too large, or is nothing that a file could hold, is refused before it is allocated."""

import tracemalloc

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sweep.quick import quick_sweep

from drake_formation.scenario import ScenarioError, load_scenario
from drake_formation.sweep import load_sweep, run_sweep
from drake_formation.sweep.axes import extent, resolve
from drake_formation.sweep.limits import MOST_POINTS, size_faults, value_faults
from drake_formation.sweep.runner import Runner
from drake_formation.sweep.schema import GridAxis, ListAxis, RandomAxis, SweepFile, Trajectories, ZipAxis

HUGE = 1_000_000_000_000
FEW = {"path": "consensus.delta", "values": [0.0, 1.0, 2.0]}
UNIFORM = {"uniform": [1.0, 2.0]}


def random_axis(count, *paths):
    return {"kind": "random", "seed": 1, "count": count, "draw": dict.fromkeys(paths or ["robots.mass"], UNIFORM)}


@pytest.mark.parametrize(
    ("axes", "message"),
    [
        ([{"path": "springs.stiffness", "logspace": [1.0, 1e9, HUGE]}], f"axes.0.logspace: {HUGE} positions"),
        ([FEW, {"path": "springs.stiffness", "linspace": [1.0, 1e9, HUGE]}], f"axes.1.linspace: {HUGE} positions"),
        ([random_axis(HUGE)], f"axes.0.count: {HUGE} positions"),
        ([random_axis(10**200)], "axes.0.count: an integer of 665 bits positions"),
        ([random_axis(MOST_POINTS // 2, "robots.mass", "avoidance.gain", "springs.damping")], "positions of 3 fields"),
        (
            [{"path": "springs.stiffness", "linspace": [1.0, 2.0, 10_000]}, random_axis(10_000)],
            "axes: 100000000 points",
        ),
        ([FEW, random_axis(MOST_POINTS)], "axes: 30000000 points"),
        (
            [{"path": f"robots.mass.{k}", "linspace": [1.0, 2.0, MOST_POINTS]} for k in range(60)],
            "axes: an integer of 1396 bits points",
        ),
    ],
)
def test_a_sweep_that_is_too_large_is_refused_before_it_is_allocated(axes, message):
    tracemalloc.start()
    try:
        with pytest.raises(ScenarioError) as error:
            load_sweep(quick_sweep(*axes))
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert f"{message}; allowed: at most {MOST_POINTS}" in str(error.value)
    assert peak < 20e6


def test_a_list_in_which_every_point_sets_another_field_is_counted_by_the_table_it_would_be():
    points = [{"label": str(k), "set": {f"field{k}": 1.0}} for k in range(4000)]
    (fault,) = size_faults([ListAxis.model_validate({"kind": "list", "points": points})])
    assert fault.message == "4000 positions of 4000 fields"


@pytest.mark.parametrize(
    "model",
    [
        GridAxis(path="a", values=(1, 2, 3)),
        GridAxis(path=("a", "b"), linspace=(0.0, 1.0, 7)),
        GridAxis(path="a", logspace=(1.0, 2.0, 5)),
        ZipAxis(kind="zip", values={"a": (1, 2), "b": (3, 4)}),
        ListAxis.model_validate({"kind": "list", "points": [{"label": "x", "set": {"a": 1, "b": 2}}]}),
        RandomAxis.model_validate(random_axis(4, "a", "b")),
    ],
)
def test_the_extent_is_what_the_axis_comes_to(model):
    axis, _ = resolve(model, ("axes", 0))
    positions, fields, source = extent(model)
    assert positions == len(axis)
    assert fields == len({id(column) for column in axis.columns.values()})
    assert source in type(model).model_fields


def test_the_place_is_said_with_file_and_line(tmp_path):
    (tmp_path / "mine.yaml").write_text(
        "name: a\nscenario: line\naxes:\n  - path: springs.stiffness\n    logspace: [1, 1e9, 1000000000000]\n"
    )
    with pytest.raises(ScenarioError, match=r"mine\.yaml:5: axes\.0\.logspace: 1000000000000 positions"):
        load_sweep(tmp_path / "mine.yaml")


@pytest.mark.parametrize("every", [1e-300, 5e-324, 1e-9])
def test_time_series_too_long_for_memory_are_refused(every):
    trajectories = {"variables": ["position"], "every": every}
    with pytest.raises(ScenarioError, match=r"trajectories\.every: \S+ numbers to keep of one run; allowed: at most"):
        load_sweep(quick_sweep(trajectories=trajectories))


def test_time_series_too_long_for_any_disk_are_refused():
    trajectories = {"variables": ["position"], "every": 1e-6}
    many = {"path": "springs.stiffness", "linspace": [1.0, 2.0, 100_000]}
    with pytest.raises(ScenarioError, match="numbers to keep of 100000 runs"):
        load_sweep(quick_sweep(many, trajectories=trajectories))


def test_a_single_run_with_too_long_time_series_fails_before_it_runs():
    trajectories = Trajectories(variables=("position",), every=0.05)
    scenario = load_scenario("line", overrides={"transport.duration": 1e6})
    with pytest.raises(ScenarioError, match="numbers to keep of one run"):
        Runner("compiled", trajectories).measure(scenario)


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=6,
)


@given(values)
def test_plain_values_are_allowed(value):
    faults = list(value_faults(value))
    assert bool(faults) == ("\\x00" in repr(value) or "\\u0000" in repr(value))


@pytest.mark.parametrize(
    ("wrong", "path"),
    [(10**309, "a.1"), ("a\0b", "a.1"), ("\ud83d", "a.1"), ({"b\0": 1}, "a.1"), ([[{"c": -(10**400)}]], "a.1.0.0.c")],
)
def test_what_no_file_could_hold_is_refused_where_it_stands(wrong, path):
    (fault,) = value_faults({"a": [1, wrong]})
    assert ".".join(map(str, fault.path)) == path


def test_the_sweep_file_model_allows_what_the_limits_are_for():
    assert SweepFile.model_validate(quick_sweep(random_axis(HUGE))).axes[0].count == HUGE
    with pytest.raises(ScenarioError, match="at most"):
        run_sweep(quick_sweep(random_axis(HUGE)), "nowhere")
