import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.sweep.axes import draws, resolve
from drake_formation.sweep.schema import Distribution, GridAxis, ListAxis, RandomAxis, ZipAxis


def axis(model):
    resolved, faults = resolve(model, ("axes", 0))
    assert not faults
    return resolved


def faults(model):
    resolved, found = resolve(model, ("axes", 0))
    assert (resolved is None) == bool(found)
    return "\n".join(map(str, found))


numbers = st.floats(-1e6, 1e6, allow_subnormal=False)


@given(first=numbers, last=numbers, count=st.integers(2, 50))
def test_linspace_has_its_ends_and_even_steps(first, last, count):
    if first == last:
        return
    values = axis(GridAxis(path="consensus.delta", linspace=(first, last, count))).columns["consensus.delta"]
    assert (values[0], values[-1], len(values)) == (first, last, count)
    np.testing.assert_allclose(np.diff(values), (last - first) / (count - 1), atol=1e-9)


@given(first=st.floats(1e-6, 1e6), ratio=st.floats(1.1, 1e6), count=st.integers(2, 50))
def test_logspace_has_its_ends_and_even_ratios(first, ratio, count):
    last = first * ratio
    values = axis(GridAxis(path="springs.stiffness", logspace=(first, last, count))).columns["springs.stiffness"]
    assert (values[0], values[-1], len(values)) == (first, last, count)
    np.testing.assert_allclose(np.diff(np.log(values)), np.log(ratio) / (count - 1), rtol=1e-6)


def test_several_paths_share_a_grid_axis():
    shared = axis(GridAxis(path=("springs.graph", "consensus.graph"), values=("cycle", [[1, 2]])))
    assert shared.overrides(1) == {"springs.graph": [[1, 2]], "consensus.graph": [[1, 2]]}


def test_paths_of_a_zip_move_together():
    zipped = axis(ZipAxis(kind="zip", values={"a": (1, 2), "b": ("x", "y")}))
    assert [zipped.overrides(k) for k in range(len(zipped))] == [{"a": 1, "b": "x"}, {"a": 2, "b": "y"}]


def test_a_point_of_a_list_leaves_alone_what_it_does_not_set():
    points = [{"label": "one", "set": {"a": 1}}, {"label": "two", "set": {"b": 2}}, {"label": "none", "set": {}}]
    listed = axis(ListAxis.model_validate({"kind": "list", "points": points}))
    assert [listed.overrides(k) for k in range(3)] == [{"a": 1}, {"b": 2}, {}]


@given(
    seed=st.integers(0, 2**40),
    count=st.integers(1, 30),
    more=st.integers(0, 30),
    one=st.sampled_from(
        [{"uniform": (1.0, 2.0)}, {"loguniform": (1e-3, 1e3)}, {"normal": (0.0, 2.0)}, {"integers": (3, 9)}]
    ),
)
def test_a_larger_count_keeps_what_was_drawn(seed, count, more, one):
    distribution = Distribution(**one)
    assert draws(seed, "a", distribution, count) == draws(seed, "a", distribution, count + more)[:count]


def test_another_field_or_seed_has_other_draws_and_changes_no_others():
    alone = axis(
        RandomAxis.model_validate({"kind": "random", "seed": 1, "count": 5, "draw": {"a": {"uniform": [0.0, 1.0]}}})
    )
    draw = {"b": {"uniform": [0.0, 1.0]}, "a": {"uniform": [0.0, 1.0]}}
    both = axis(RandomAxis.model_validate({"kind": "random", "seed": 1, "count": 5, "draw": draw}))
    other = axis(RandomAxis.model_validate({"kind": "random", "seed": 2, "count": 5, "draw": draw}))
    assert alone.columns["a"] == both.columns["a"]
    assert both.columns["a"] != both.columns["b"]
    assert other.columns["a"] != both.columns["a"]


@pytest.mark.parametrize(
    ("one", "mean", "deviation"),
    [
        ({"uniform": (2.0, 4.0)}, 3.0, 2 / 12**0.5),
        ({"normal": (5.0, 0.5)}, 5.0, 0.5),
        ({"integers": (0, 10)}, 5.0, 10**0.5),
    ],
)
def test_draws_have_their_distributions_moments(one, mean, deviation):
    values = np.array(draws(3, "a", Distribution(**one), 20_000), dtype=float)
    assert values.mean() == pytest.approx(mean, abs=5 * deviation / 20_000**0.5)
    assert values.std() == pytest.approx(deviation, rel=0.03)


def test_loguniform_is_uniform_in_the_logarithm():
    exponents = np.log10(draws(4, "a", Distribution(loguniform=(1e-2, 1e4)), 20_000))
    assert exponents.min() >= -2
    assert exponents.max() <= 4
    np.testing.assert_allclose(np.histogram(exponents, 6, (-2, 4))[0], 20_000 / 6, rtol=0.06)


def test_integers_are_whole_and_reach_both_ends():
    values = draws(5, "a", Distribution(integers=(1, 3)), 100)
    assert set(values) == {1, 2, 3}
    assert all(type(value) is int for value in values)


@pytest.mark.parametrize(
    ("model", "message"),
    [
        (GridAxis(path="a"), "without values"),
        (GridAxis(path="a", values=(1,), linspace=(0.0, 1.0, 2)), "values and linspace given"),
        (GridAxis(path="a", logspace=(0.0, 1.0, 2)), "logspace: out of range"),
        (GridAxis(path="a", linspace=(1.0, 1.0, 2)), "all values are the same"),
        (GridAxis(path="a", values=(1, 2, 1.0)), "values.2: given twice"),
        (GridAxis(path="a", values=([1, 2], [1, 2])), "values.1: given twice"),
        (GridAxis(path=("a", "a"), values=(1,)), "path.1: given twice"),
        (GridAxis(path="a", values=(1, 2), labels=("x",)), "1 labels for 2 positions"),
        (GridAxis(path="a", linspace=(0.0, 1.0, 2), labels=("x", "x")), "labels.1: given twice"),
        (ZipAxis(kind="zip", values={"a": (1, 2), "b": (1,)}), "2 of a, 1 of b"),
        (ZipAxis(kind="zip", values={"a": (1, 2)}, labels=("x",)), "1 labels for 2 positions"),
        (ListAxis.model_validate({"kind": "list", "points": [{"label": "x", "set": {}}]}), "nothing is set"),
        (ListAxis.model_validate({"kind": "list", "points": [{"label": "x", "set": {"a": 1}}] * 2}), "given twice"),
    ],
)
def test_what_is_wrong_with_an_axis(model, message):
    assert message in faults(model)


@pytest.mark.parametrize(
    ("one", "message"),
    [
        ({}, "no distribution"),
        ({"uniform": [0.0, 1.0], "normal": [0.0, 1.0]}, "uniform and normal given"),
        ({"uniform": [1.0, 0.0]}, "low <= high"),
        ({"loguniform": [0.0, 1.0]}, "0 < low"),
        ({"normal": [0.0, -1.0]}, "standard deviation >= 0"),
        ({"integers": [0, 2**70]}, "64 bits"),
    ],
)
def test_what_is_wrong_with_a_distribution(one, message):
    model = RandomAxis.model_validate({"kind": "random", "seed": 1, "count": 2, "draw": {"a": one}})
    assert "axes.0.draw.a" in faults(model)
    assert message in faults(model)
