"""Whatever chunks are made, in whatever order they end and whoever dies over them, every point comes out once."""

import random
from collections import namedtuple
from concurrent.futures import Future
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sweep.quick import quick_sweep

from drake_formation.sweep import load_sweep
from drake_formation.sweep.drive import MOST_POINTS, drive
from drake_formation.sweep.work import Outcome, Report, Task, versions

SWEEP = load_sweep(quick_sweep({"path": "springs.stiffness", "linspace": [1.0, 2.0, 3000]}))
TASK = Task(SWEEP.base.data, "compiled", None, versions())
Waited = namedtuple("Waited", "done")


class DeathError(Exception):
    pass


class Imagined:
    """An executor that runs nothing: some points kill their worker, and chunks end in random order when waited for."""

    blocking = False
    deaths = (DeathError,)

    def __init__(self, slots, deadly=(), unlucky=0, seconds=1e-3, seed=0):
        self.slots, self.deadly, self.unlucky, self.seconds = slots, set(deadly), unlucky, seconds
        self.chunks, self.sizes, self.most = {}, [], 0
        self._random = random.Random(seed)

    def submit(self, chunk):
        future = Future()
        self.chunks[future] = chunk
        self.sizes.append(len(chunk.points))
        self.most = max(self.most, len(self.chunks))
        return future

    def wait(self, futures, return_when):
        """Let some of the chunks at work end."""
        waiting = list(futures)
        self._random.shuffle(waiting)
        done = waiting[: self._random.randint(1, len(waiting))]
        for future in done:
            self.end(self.chunks.pop(future), future)
        return Waited(done)

    def end(self, chunk, future):
        indices = [index for index, _ in chunk.points]
        if self.deadly & set(indices) or self.unlucky > 0:
            self.unlucky -= 1
            future.set_exception(DeathError("killed by signal 9"))
        else:
            outcomes = [
                Outcome(index, None, {"x": np.array(sets["springs.stiffness"])}) for index, sets in chunk.points
            ]
            self._random.shuffle(outcomes)
            future.set_result(Report(outcomes, self.seconds * len(indices), 1))


def driven(executor, points):
    kept = []
    with patch("drake_formation.sweep.drive.wait", executor.wait):
        drive(SWEEP, TASK, np.array(points, dtype=int), executor, kept.extend)
    assert sorted(outcome.index for outcome in kept) == sorted(points)
    return {outcome.index: outcome for outcome in kept}


@given(
    slots=st.integers(1, 9),
    points=st.sets(st.integers(0, 2999), max_size=400),
    deadly=st.sets(st.integers(0, 2999), max_size=5),
    seconds=st.floats(1e-5, 10),
    seed=st.integers(),
)
def test_every_point_comes_out_once_and_only_culprits_fail(slots, points, deadly, seconds, seed):
    deadly &= points
    executor = Imagined(slots, deadly, seconds=seconds, seed=seed)
    kept = driven(executor, sorted(points))
    assert {index for index, outcome in kept.items() if outcome.error} == deadly
    assert all("signal 9" in kept[index].error for index in deadly)
    for index in points - deadly:
        assert kept[index].values["x"] == SWEEP.overrides(index)["springs.stiffness"]
    assert executor.most <= slots


def test_a_worker_killed_from_outside_costs_nothing():
    kept = driven(Imagined(2, unlucky=1), range(100))
    assert not any(outcome.error for outcome in kept.values())


def test_chunks_grow_with_quick_runs_and_shrink_towards_the_end():
    executor = Imagined(2, seconds=5e-3)
    driven(executor, range(3000))
    assert executor.sizes[0] == 1
    assert max(executor.sizes) == 200  # a second's worth
    assert executor.sizes[-1] <= 4


def test_chunks_of_very_quick_runs_are_bounded():
    executor = Imagined(2, seconds=1e-5)
    driven(executor, range(3000))
    assert max(executor.sizes) == MOST_POINTS


def test_slow_runs_come_one_by_one():
    executor = Imagined(2, seconds=30.0)
    driven(executor, range(50))
    assert set(executor.sizes) == {1}


def test_what_is_no_death_ends_the_sweep():
    class Broken(Imagined):
        def end(self, chunk, future):
            future.set_exception(MemoryError("no more"))

    with pytest.raises(MemoryError):
        driven(Broken(1), range(3))


class Immediate(Imagined):
    """Runs a chunk before it returns, and notes what was not kept by then."""

    blocking = True

    def __init__(self, kept):
        super().__init__(1, seconds=0.3)
        self.kept, self.unkept = kept, []

    def submit(self, chunk):
        self.unkept.append(sum(self.sizes) - len(self.kept))
        future = super().submit(chunk)
        self.end(chunk, future)
        return future


def test_what_this_process_ran_is_kept_before_it_runs_on():
    kept = []
    executor = Immediate(kept)
    drive(SWEEP, TASK, np.arange(50), executor, kept.extend)
    assert len(kept) == 50
    assert set(executor.unkept) == {0}
