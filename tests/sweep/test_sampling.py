import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import load_scenario
from drake_formation.simulation import PreparedRun
from drake_formation.sweep.sampling import sample, sample_times
from drake_formation.sweep.schema import SERIES

SCENARIO = load_scenario("line", overrides={"aggregation.duration": 1.25, "transport.duration": 2.0})


@pytest.fixture(scope="module")
def series():
    return PreparedRun(SCENARIO, engine="compiled").run(SCENARIO)


@given(every=st.floats(1e-2, 10), count=st.integers(0, 100), rest=st.floats(0, 0.99))
def test_samples_are_the_multiples_of_the_interval_that_fit(every, count, rest):
    times = sample_times((count + rest) * every, every)
    assert len(times) == count + 1
    np.testing.assert_array_equal(times, every * np.arange(count + 1))


def test_samples_begin_and_end_with_the_run(series):
    sampled = sample(series, ["position"], 0.25)["position"]
    assert sampled.shape == (14, 2, 2)
    np.testing.assert_array_equal(sampled[0], series["position"][0])
    np.testing.assert_allclose(sampled[-1], series["position"][-1], atol=1e-12)


@pytest.mark.parametrize("name", SERIES)
def test_samples_agree_with_a_run_of_far_finer_steps(series, name):
    fine = load_scenario(
        "line",
        overrides={
            "aggregation.duration": 1.25,
            "transport.duration": 2.0,
            "simulator.max_step_size": 2e-3,
            "simulator.accuracy": 1e-10,
        },
    )
    wanted = sample(PreparedRun(fine, engine="compiled").run(fine), [name], 0.1)[name]
    found = sample(series, [name], 0.1)[name]
    largest = np.nanmax(np.abs(wanted))
    np.testing.assert_allclose(found, wanted, atol=1e-3 * largest + 1e-6)


def test_positions_are_within_a_tenth_of_a_millimetre(series):
    times = sample_times(3.25, 0.05)
    fine = SCENARIO.model_copy(
        update={"simulator": SCENARIO.simulator.model_copy(update={"max_step_size": 2e-3, "accuracy": 1e-10})}
    )
    wanted = sample(PreparedRun(fine, engine="compiled").run(fine), ["position"], 0.05)["position"]
    assert len(times) == len(wanted)
    np.testing.assert_allclose(sample(series, ["position"], 0.05)["position"], wanted, atol=1e-4)


def test_forces_jump_at_the_hand_off_and_not_before(series):
    times = sample_times(3.25, 0.05)
    force = sample(series, ["tracking_force"], 0.05)["tracking_force"]
    before, after = force[times < 1.25], force[times >= 1.25]
    at = int(np.argmax(series["time"] >= 1.25))
    np.testing.assert_allclose(after[0], series["tracking_force"][at])
    assert np.abs(before).max() < 5
    assert np.abs(after[0]).max() > 15


def test_the_deviation_is_not_known_before_the_hand_off(series):
    deviation = sample(series, ["deviation"], 0.25)["deviation"]
    assert np.isnan(deviation[:5]).all()
    assert np.isfinite(deviation[5:]).all()
