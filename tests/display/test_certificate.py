"""A certificate in a notebook says what the terminal does."""

from shown import Shown

from drake_formation import load_scenario
from drake_formation.analysis import linearize, modes
from drake_formation.analysis.certificate import Certificate


def test_it_has_the_verdict_and_what_it_rests_on():
    formation = linearize(load_scenario("line"))
    unanswered = {"loss": "<script>alert(1)</script>"}
    shown = Shown(Certificate(load_scenario("line"), formation, modes(formation), unanswered=unanswered)._repr_html_())
    assert not shown.runs
    assert "line: certificate of the formation at rest" in shown.text
    assert "stable: yes." in shown.text
    assert "<script>" in shown.text.replace("\n", "")
