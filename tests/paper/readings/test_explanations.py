"""Explanations that were looked into."""

import pytest
from same_figures import SameFigures

from drake_formation.paper.readings import explanations
from drake_formation.paper.readings.simulated import SIMULATED
from drake_formation.paper.readings.two_readings import PROBABLE
from drake_formation.scenario import with_overrides

CASE = ("line", "rubber", 1e4)


@pytest.mark.parametrize("solver", explanations.SOLVERS)
def test_a_solver_changes_nothing_else(solver):
    run, base = explanations.solved(solver)(*CASE), PROBABLE.transport(*CASE)
    assert run != base
    assert run.model_copy(update={"simulator": base.simulator}) == base


def test_the_moment_of_the_reading_gives_its_run():
    run = explanations.handed_over_at("line", SIMULATED["line"].duration, 1e4)
    base = PROBABLE.transport(*CASE)
    assert with_overrides(run, {"transport.duration": base.transport.duration}) == base


def test_the_text_says_which_cells_change_and_when_forces_agree(monkeypatch):
    monkeypatch.setattr(explanations, "MOMENTS", (SIMULATED["line"].duration,))
    text = explanations.explanations_part().make(SameFigures()).text
    assert "| fixed steps of 10 ms | 0 cm | 0 N | 0 | 0 |" in text
    assert "0: none" in text

    class Published(SameFigures):
        def measured(self, scenario):
            figures = super().measured(scenario)
            force = {1e4: 45.0, 2e4: 95.0}.get(scenario.consensus.delta, 1.0)
            return type(figures)(**{**figures, "peak_force_n": force})

    text = explanations.explanations_part().make(Published()).text
    assert "| line | 45 N | 95 N | 45 to 45 N | 95 to 95 N | 1: 60 | 60 s |" in text
