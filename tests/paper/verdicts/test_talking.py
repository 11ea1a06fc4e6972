"""Claims about communication, on figures made up to decide them."""

import pytest

from drake_formation.measuring import Metrics
from drake_formation.paper.readings.two_readings import PROBABLE
from drake_formation.paper.verdicts.talking import exponential_cost, ten_as_twelve, topologies_beat_local
from drake_formation.paper.verdicts.verdict import FAILS, HOLDS, VACUOUS


class Figures:
    """Errors by the number of channels; the rest is the same for all."""

    def __init__(self, errors, residual=0.1):
        self._errors, self._residual = errors, residual

    def measured(self, scenario):
        from drake_formation.formation import graphs
        from drake_formation.scenario import resolve

        channels = graphs.channels(resolve(scenario).channels.graph) if scenario.consensus.delta else 0
        error = self._errors[channels]
        return Metrics(consensus_error_m=error, disagreement_m=error, residual_m=self._residual)


@pytest.mark.parametrize(
    ("errors", "residual", "verdict"),
    [
        ({12: 4.0, 10: 4.1, 8: 5.0, 6: 9.0}, 0.1, HOLDS),
        ({12: 4.0, 10: 4.8, 8: 5.0, 6: 9.0}, 0.1, FAILS),
        ({12: 4.0, 10: 4.1, 8: 4.2, 6: 4.4}, 9.0, VACUOUS),
    ],
)
def test_what_the_hand_off_hides_is_no_verdict_on_channels(errors, residual, verdict):
    assert ten_as_twelve(PROBABLE, Figures(errors, residual)).verdict == verdict


def test_topologies_are_held_against_no_communication():
    errors = {12: 4.0, 10: 4.0, 8: 5.0, 6: 9.0}
    assert topologies_beat_local(PROBABLE, Figures(errors | {0: 10.0})).verdict == HOLDS
    assert topologies_beat_local(PROBABLE, Figures(errors | {0: 8.0})).verdict == FAILS


def test_channels_of_a_complete_graph_grow_with_the_square():
    found = exponential_cost(None)
    assert found.verdict == FAILS
    assert "2 for 2, 12 for 4, 56 for 8, 240 for 16, 992 for 32" in found.evidence
