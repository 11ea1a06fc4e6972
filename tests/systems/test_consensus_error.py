import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from strategies import generators

from drake_formation.systems.consensus_error import ConsensusError, consensus_errors

counts = st.integers(1, 8)


@given(counts, generators)
def test_errors_sum_to_zero(robots, rng):
    errors = consensus_errors(rng.normal(size=(robots, 2)), rng.normal(size=(robots, 2)))
    np.testing.assert_allclose(errors.sum(axis=0), 0, atol=1e-12)


@given(counts, generators)
def test_robots_in_formation_have_no_error_wherever_they_are(robots, rng):
    slots = rng.normal(size=(robots, 2))
    np.testing.assert_allclose(consensus_errors(slots + rng.normal(size=2), slots), 0, atol=1e-12)


def test_two_robots_share_their_disagreement():
    slots = np.array([[0.0, -0.5], [0.0, 0.5]])
    positions = np.add(slots, [[0.0, 0.0], [0.2, 0.0]])
    np.testing.assert_allclose(consensus_errors(positions, slots), [[-0.1, 0], [0.1, 0]], atol=1e-15)


@given(counts, generators)
def test_the_observer_gives_every_robots_error(robots, rng):
    slots, states = rng.normal(size=(robots, 2)), rng.normal(size=(robots, 4))
    observer = ConsensusError(slots)
    context = observer.CreateDefaultContext()
    for i, state in enumerate(states):
        observer.GetInputPort(f"state_{i + 1}").FixValue(context, state)
    errors = [observer.GetOutputPort(f"error_{i + 1}").Eval(context) for i in range(robots)]
    np.testing.assert_array_equal(errors, consensus_errors(states[:, :2], slots))


def test_a_series_is_measured_sample_by_sample():
    positions, slots = np.random.default_rng(0).normal(size=(5, 3, 2)), np.zeros((3, 2))
    series = consensus_errors(positions, slots)
    np.testing.assert_array_equal(series, [consensus_errors(sample, slots) for sample in positions])
