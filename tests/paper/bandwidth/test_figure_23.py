"""Fig. 23 in both readings: what the channels hold, and what is left."""

import pytest

from drake_formation.paper.bandwidth import figure_23
from drake_formation.paper.store import Store


@pytest.mark.slow
def test_ten_channels_do_as_twelve_and_what_is_left_is_a_rotation(tmp_path):
    store = Store(tmp_path)
    measured = figure_23.figure_23_measured(store)
    on_distances = {name: 100 * its.consensus_error_m for name, its in measured[figure_23.DISTANCES].items()}
    assert list(on_distances.values()) == pytest.approx([12.05, 4.09, 4.09, 4.68, 4.79, 11.09], abs=0.005)
    left = measured[figure_23.DISTANCES]["10 channels"]
    assert left.deformed_m < 0.1 * left.turned_m
    text = figure_23.of_the_paper(measured)
    assert f"{on_distances['10 channels']:.2f} cm, is a rotation" in text
    assert "| 10 channels | 5 of 5 | minimally rigid |" in figure_23.figure_23_table(measured)
