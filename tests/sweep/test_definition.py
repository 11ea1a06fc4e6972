import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sweep.quick import FAILING, QUICK, quick_sweep

from drake_formation import load_scenario
from drake_formation.scenario import ScenarioError
from drake_formation.sweep import load_sweep
from drake_formation.sweep.definition import point_scenario, probes


def test_grid_axes_multiply_with_the_last_fastest(sweep):
    stiffness = np.geomspace(1.0, 1e4, 4).tolist()
    wanted = list(itertools.product(stiffness, [0.0, 10.0, 1e3]))
    assert (len(sweep), sweep.shape) == (12, (4, 3))
    for index, (k, delta) in enumerate(wanted):
        assert sweep.overrides(index) == {"springs.stiffness": k, "consensus.delta": delta}


@given(
    st.lists(st.integers(1, 4), min_size=1, max_size=3).flatmap(
        lambda shape: st.tuples(st.just(shape), st.integers(0, 63))
    )
)
def test_points_are_numbered_as_a_c_ordered_array(case):
    sizes, index = case
    paths = ["springs.stiffness", "consensus.delta", "avoidance.gain"]
    axes = [{"path": path, "values": [float(k) for k in range(size)]} for path, size in zip(paths, sizes, strict=False)]
    made = load_sweep(quick_sweep(*axes))
    index %= len(made)
    positions = made.positions(index)
    assert np.ravel_multi_index(positions, made.shape) == index
    assert list(made.overrides(index).values()) == [float(k) for k in positions]


def test_a_point_is_the_scenario_with_its_overrides(sweep):
    wanted = load_scenario("line", overrides=QUICK | sweep.overrides(7))
    assert sweep.scenario(7) == wanted


def test_every_kind_of_value_can_be_swept():
    axes = [
        {"path": ["springs.graph", "consensus.graph"], "values": ["cycle", [[1, 2], [2, 3], [3, 4]]]},
        {"path": "avoidance.obstacles", "values": [[], [{"position": [9.0, 9.0]}]], "name": "obstacles"},
        {"path": "robots.mass.1", "values": [30.0, 50.0]},
        {
            "path": "formation",
            "values": [
                {"shape": "polygon", "robots": 4, "side": 1.0},
                {"shape": "grid", "rows": 2, "columns": 2, "side": 1.0},
            ],
        },
    ]
    settings = QUICK | {"robots.mass": [40.0, 40.0, 40.0, 40.0]}
    made = load_sweep(quick_sweep(*axes) | {"scenario": "quadrilateral", "set": settings})
    last = made.scenario(len(made) - 1)
    assert last.springs.graph == last.consensus.graph == ((1, 2), (2, 3), (3, 4))
    assert last.avoidance.obstacles[0].position == (9.0, 9.0)
    assert last.robots.mass == (40.0, 50.0, 40.0, 40.0)
    assert last.formation.shape == "grid"


def test_there_is_no_point_beyond_the_last(sweep):
    with pytest.raises(IndexError, match="0 to 11, not 12"):
        sweep.scenario(12)


def test_a_wrong_point_says_what_is_wrong_without_where_it_was_set():
    made = load_sweep(quick_sweep(FAILING))
    with pytest.raises(ScenarioError) as error:
        point_scenario(made.base, made.overrides(1))
    assert str(error.value).startswith("robots.mass")


def test_probes_hold_every_written_value_and_both_ends_of_an_interval():
    axes = [
        {"path": "springs.stiffness", "values": [1.0, 2.0, 3.0]},
        {"path": "consensus.delta", "linspace": [0.0, 1.0, 1000]},
        {"kind": "random", "seed": 1, "count": 1000, "draw": {"robots.mass": {"normal": [40.0, 1.0]}}},
    ]
    made = load_sweep(quick_sweep(*axes))
    found = list(probes(made))
    assert len(found) == len(set(found)) == 4
    assert {made.overrides(k)["springs.stiffness"] for k in found} == {1.0, 2.0, 3.0}
    assert {made.overrides(k)["consensus.delta"] for k in found} == {0.0, 1.0}


def test_the_fingerprint_is_of_what_decides_the_runs(sweep):
    same = load_sweep(quick_sweep(name="other", description="words"))
    assert same.fingerprint() == sweep.fingerprint()
    assert replace(sweep, text="# a comment").fingerprint() == sweep.fingerprint()


STIFFNESS = {"path": "springs.stiffness", "logspace": [1.0, 1e4, 4]}


@pytest.mark.parametrize(
    "change",
    [
        {"set": QUICK | {"robots.mass": 41.0}},
        {"scenario": "quadrilateral"},
        {"axes": [STIFFNESS]},
        {"axes": [STIFFNESS, {"path": "consensus.delta", "values": [0.0, 1e3, 10.0]}]},
        {"axes": [STIFFNESS, {"path": "consensus.delta_v", "values": [0.0, 10.0, 1e3]}]},
        {"trajectories": {"variables": ["position"]}},
    ],
)
def test_whatever_changes_a_run_changes_the_fingerprint(sweep, change):
    assert load_sweep(quick_sweep() | change).fingerprint() != sweep.fingerprint()
