import io
import re

import pytest
from rich.console import Console
from sweep.quick import quick_sweep

from drake_formation.sweep import Tally, run_sweep
from drake_formation.sweep.terminal import closing, duration, progress_bar, summary


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.4, "0 s"), (59.4, "59 s"), (59.6, "1 min 0 s"), (185, "3 min 5 s"), (7620, "2 h 7 min"), (1e6, "277 h 46 min")],
)
def test_durations_are_said_as_one_would(seconds, text):
    assert duration(seconds) == text


def test_the_rate_is_of_this_call_alone():
    clock = [0.0]
    console = Console(file=io.StringIO(), force_terminal=True, width=120, get_time=lambda: clock[0])
    with progress_bar("mine", console) as report:
        report(Tally(total=1000, finished=900, failed=0, resumed=900))
        for step in range(1, 6):
            clock[0] = float(step)
            report(Tally(total=1000, finished=900 + 10 * step, failed=step, resumed=900))
    text = console.file.getvalue()
    assert "mine, 5 failed" in text
    assert "950 / 1000 runs" in text
    assert "10 runs/s, 5 s left" in text


def test_the_summary_has_every_metric_with_its_unit(tmp_path):
    sweep = quick_sweep({"path": "consensus.delta", "values": [0.0, 1.0]})
    with run_sweep(sweep, tmp_path, executor="serial") as dataset:
        console = Console(file=io.StringIO(), width=120)
        console.print(summary(dataset))
        text = console.file.getvalue()
        assert "quick, 2 delta" in text
        assert "peak control force" in text
        assert re.search(r"settled within 2 % after +none", text)
        message, failed = closing(dataset, tmp_path)
    assert failed == 0
    assert message == f"2 runs in {tmp_path}/sweep.nc, pictures in {tmp_path}/figures."
