"""Explanations that were looked into and do not explain the misses: the solver, and the time of the hand-off."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from drake_formation.markdown import markdown_table
from drake_formation.paper.published import published
from drake_formation.paper.readings import PROBABLE, Run
from drake_formation.paper.runs import CASES, FORMATIONS, GAINS
from drake_formation.paper.score import agrees, score
from drake_formation.paper.section import Part, Section
from drake_formation.paper.simulated import SIMULATED, handed_over
from drake_formation.paper.store import Store
from drake_formation.paper.tables import all_entries, transports
from drake_formation.scenario import Scenario, with_overrides

SOLVERS: Mapping[str, dict[str, Any]] = {
    "as the study": {},
    "variable steps at 1e-3, ode45's tolerance": {"simulator.accuracy": 1e-3, "simulator.max_step_size": 0.1},
    "fixed steps of 10 ms": {"simulator.use_error_control": False, "simulator.max_step_size": 0.01},
    "fixed steps of 5 ms": {"simulator.use_error_control": False, "simulator.max_step_size": 0.005},
}

MOMENTS = tuple(40.0 + 2.5 * k for k in range(17))
"""Times of the hand-off that are tried (s)."""
PEAK = 5.0
"""The peak force after the hand-off is over by then (s)."""


def explanations_part() -> Part:
    """Both tables."""
    return Part(
        make=lambda store: Section(title="What does not explain the misses", text=_text(store)),
        measured=lambda: [
            *(run for solver in SOLVERS for run in transports(solved(solver))),
            *(handed_over_at(name, moment, delta) for name in FORMATIONS for moment in MOMENTS for delta in GAINS[1:]),
        ],
    )


def solved(solver: str) -> Run:
    """The transports as probably simulated, by a solver."""
    if not SOLVERS[solver]:
        return PROBABLE.transport
    return lambda *case: with_overrides(PROBABLE.transport(*case), SOLVERS[solver])


def handed_over_at(formation: str, moment: float, delta: float) -> Scenario:
    """A transport with rubber, as probably simulated but for the time of the hand-off, while its force peaks."""
    settings = replace(SIMULATED[formation], duration=moment)
    return with_overrides(handed_over(formation, settings, "rubber", delta), {"transport.duration": PEAK})


def _text(store: Store) -> str:
    return "\n\n".join([
        "**The solver.** As probably simulated, by how an integrator might have been set, and how far errors and "
        "forces then move at the most:",
        _solvers(store),
        "**The hand-off.** With consensus the peak force depends on the moment of the hand-off, since it is how far "
        "the ringing virtual springs are out of place then. T_agg is not printed; it decides no error and all forces. "
        f"Of {len(MOMENTS)} moments from {MOMENTS[0]:g} to {MOMENTS[-1]:g} s:",
        _moments(store),
    ])  # fmt: skip


def _solvers(store: Store) -> str:
    exact = {case: store.measured(PROBABLE.transport(*case)) for case in CASES}
    rows = []
    for solver in SOLVERS:
        run = solved(solver)
        ours = {case: store.measured(run(*case)) for case in CASES}
        error = max(abs(ours[case].consensus_error_m - exact[case].consensus_error_m) for case in CASES)
        force = {case: abs(ours[case].peak_force_n - exact[case].peak_force_n) for case in CASES}
        its = score((entry.published, entry.ours) for entry in all_entries(store, run))
        worst = max(force, key=force.__getitem__)
        rows.append([
            solver, f"{100 * error:.3f} cm", f"{force[worst]:.2g} N ({', '.join(map(_said, worst))})", f"**{its}**"
        ])  # fmt: skip
    return markdown_table(["solver", "e moves by", "u moves by", "cells that agree"], rows)


def _moments(store: Store) -> str:
    rows = []
    for name in FORMATIONS:
        printed = published()[name]["peak_force"]["rubber"]
        forces = {
            moment: [store.measured(handed_over_at(name, moment, delta)).peak_force_n for delta in GAINS[1:]]
            for moment in MOMENTS
        }
        right = [
            moment
            for moment, ours in forces.items()
            if all(agrees(printed[delta], force) for delta, force in zip(GAINS[1:], ours, strict=True))
        ]
        spans = [f"{min(column):.0f} to {max(column):.0f} N" for column in zip(*forces.values(), strict=True)]
        wanted = [f"{printed[delta]:g} N" for delta in GAINS[1:]]
        listed = ", ".join(f"{moment:g}" for moment in right) or "none"
        rows.append([name, *wanted, *spans, f"{len(right)} of {len(MOMENTS)}: {listed}"])
    gains = [f"δ = {delta:g}" for delta in GAINS[1:]]
    heading = ["rubber", *(f"published, {g}" for g in gains), *gains, "moments at which both agree (s)"]
    return markdown_table(heading, rows)


def _said(value: object) -> str:
    return f"δ = {value:g}" if isinstance(value, float) else str(value)
