"""Explanations that were looked into and do not explain the misses: the solver, and the time of the hand-off."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from drake_formation.markdown import markdown_table
from drake_formation.paper.published import published
from drake_formation.paper.readings.score import agrees
from drake_formation.paper.readings.simulated import SIMULATED, handed_over
from drake_formation.paper.readings.two_readings import PROBABLE, Run
from drake_formation.paper.runs import CASES, FORMATIONS, GAINS
from drake_formation.paper.section import Part, Section
from drake_formation.paper.store import Store
from drake_formation.paper.tables import all_entries, transports
from drake_formation.scenario import Scenario, with_overrides

SOLVERS: Mapping[str, dict[str, Any]] = {
    "variable steps at 1e-3, ode45's tolerance": {"simulator.accuracy": 1e-3, "simulator.max_step_size": 0.1},
    "fixed steps of 10 ms": {"simulator.use_error_control": False, "simulator.max_step_size": 0.01},
    "fixed steps of 5 ms": {"simulator.use_error_control": False, "simulator.max_step_size": 0.005},
}

MOMENTS = tuple(float(moment) for moment in range(40, 81))
"""Times of the hand-off that are tried (s)."""
PEAK = 5.0
"""The peak force after the hand-off is over by then (s)."""
COUPLED = GAINS[1:]


def explanations_part() -> Part:
    """Both tables."""
    return Part(
        make=lambda store: Section(title="What does not explain the misses", text=_text(store)),
        measured=lambda: [
            *(run for solver in SOLVERS for run in transports(solved(solver))),
            *(handed_over_at(name, moment, delta) for name in FORMATIONS for moment in MOMENTS for delta in COUPLED),
        ],
    )


def solved(solver: str) -> Run:
    """The transports as probably simulated, by a solver."""
    return lambda *case: with_overrides(PROBABLE.transport(*case), SOLVERS[solver])


def handed_over_at(formation: str, moment: float, delta: float) -> Scenario:
    """A transport with rubber, as probably simulated but for the time of the hand-off, while its force peaks."""
    settings = replace(SIMULATED[formation], duration=moment)
    return with_overrides(handed_over(formation, settings, "rubber", delta), {"transport.duration": PEAK})


def _text(store: Store) -> str:
    return "\n\n".join([
        "**The solver.** As probably simulated, by how an integrator might have been set: how far errors and forces "
        "then move at the most, and which cells come to agree or no longer do:",
        _solvers(store),
        "**The hand-off.** With consensus the peak force is how far the ringing virtual springs are out of place at "
        "the hand-off, times δ, and T_agg is not printed. Moments at which the forces of a formation with rubber "
        f"agree, of the {len(MOMENTS)} full seconds from {MOMENTS[0]:g} to {MOMENTS[-1]:g} s; where T_agg is free, "
        "agreeing forces are no evidence:",
        _moments(store),
    ])  # fmt: skip


def _solvers(store: Store) -> str:
    """What solvers change, and how little of what is missed that explains."""
    exact = {case: store.measured(PROBABLE.transport(*case)) for case in CASES}
    right = [agrees(entry.published, entry.ours) for entry in all_entries(store, PROBABLE.transport)]
    rows, best = [], 0
    for solver in SOLVERS:
        run = solved(solver)
        ours = {case: store.measured(run(*case)) for case in CASES}
        error = max(abs(ours[case].consensus_error_m - exact[case].consensus_error_m) for case in CASES)
        force = max(abs(ours[case].peak_force_n - exact[case].peak_force_n) for case in CASES)
        now = [agrees(entry.published, entry.ours) for entry in all_entries(store, run)]
        gained = sum(new and not old for new, old in zip(now, right, strict=True))
        lost = sum(old and not new for new, old in zip(now, right, strict=True))
        best = max(best, gained)
        rows.append([solver, f"{100 * error:.2g} cm", f"{force:.2g} N", str(gained), str(lost)])
    table = markdown_table(["solver", "e moves by", "u moves by", "cells gained", "cells lost"], rows)
    return f"{table}\n\nOf {right.count(False)} cells that are missed, no solver gains more than {best}."


def _moments(store: Store) -> str:
    rows = []
    for name in FORMATIONS:
        printed = [published()[name]["peak_force"]["rubber"][delta] for delta in COUPLED]
        forces = {
            moment: [store.measured(handed_over_at(name, moment, delta)).peak_force_n for delta in COUPLED]
            for moment in MOMENTS
        }
        right = [f"{moment:g}" for moment, ours in forces.items() if all(map(agrees, printed, ours))]
        spans = [f"{min(column):.0f} to {max(column):.0f} N" for column in zip(*forces.values(), strict=True)]
        used = f"{SIMULATED[name].duration:g} s"
        rows.append([
            name, *(f"{force:g} N" for force in printed), *spans, f"{len(right)}: {', '.join(right) or 'none'}", used
        ])  # fmt: skip
    gains = [f"δ = {delta:g}" for delta in COUPLED]
    heading = ["formation", *(f"published, {g}" for g in gains), *gains, "moments at which both agree (s)", "used"]
    return markdown_table(heading, rows)
