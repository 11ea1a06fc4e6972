"""Each panel of the sensitivity figure varies one inferred parameter about the study's own value."""

import pytest

from drake_formation.paper.runs import transport
from drake_formation.paper.sensitivity import DELTAS, PARAMETERS, sensitivity_runs, varied


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_the_middle_value_is_the_studys_own(parameter):
    values = PARAMETERS[parameter]
    assert varied(parameter, values[len(values) // 2], 0.0) == transport("line", "rubber", 0.0)


def test_every_other_value_is_another_run():
    runs = sensitivity_runs()
    assert len({run.model_dump_json() for run in runs}) == len(runs) - (len(PARAMETERS) - 1) * len(DELTAS)
