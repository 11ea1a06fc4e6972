"""Theorems 1 and 2, Lemmas 1-4 and K_l, checked on the matrices of the actual diagrams."""

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import InputPortSelection, OutputPortSelection
from pydrake.systems.primitives import Linearize

from drake_formation.diagram import build_diagram
from drake_formation.formation import graphs
from drake_formation.paper.figures.curves import phase
from drake_formation.paper.published import published
from drake_formation.paper.runs import TOPOLOGIES, topology
from drake_formation.paper.store import Store
from drake_formation.paper.verdicts.verdict import FAILS, HOLDS, Claim, verdict
from drake_formation.parameters import find_block
from drake_formation.parts.tracking.lqr import robot_matrices
from drake_formation.scenario import Scenario, load_scenario, resolve, with_overrides

MARGIN = 1e-3
"""Eigenvalues closer to the imaginary axis than this (1/s) are on it; a double zero is found to about 1e-6 only."""


def gain(_store: Store) -> Claim:
    """Sec. 5.1: K_l."""
    ours = _tracking_gain()
    printed = published()["lqr"]["K_l"]
    error = float(np.abs(ours - printed).max())
    return Claim(
        claim=f"K_l = [{'; '.join(' '.join(f'{gain:g}' for gain in row) for row in printed)}] (Sec. 5.1)",
        verdict=HOLDS if error < 1e-12 else FAILS,
        evidence=f"largest deviation {error:.1e}",
        source="the tracking block of the line's diagram",
    )


def _tracking_gain() -> NDArray[np.float64]:
    """K_l of the line's first robot, as its block has it, shape (2, 4)."""
    block = find_block(build_diagram(load_scenario("line")), "robot_1/tracking")
    gain: NDArray[np.float64] = block.CreateDefaultContext().get_numeric_parameter(0).CopyToVector().reshape(2, 4)
    return gain


def theorem_1(_store: Store) -> Claim:
    """Theorem 1 on the matrices of the diagram."""
    a, b = robot_matrices(published()["robot_mass_kg"])
    slowest = float(np.linalg.eigvals(a - b @ _tracking_gain()).real.max())
    return Claim(
        claim="Theorem 1: the local tracking error is asymptotically stable",
        verdict=HOLDS if slowest < 0 else FAILS,
        evidence=f"A − BK_l is Hurwitz: all eigenvalues at or left of {slowest:.4f} 1/s",
        source="the line's diagram",
    )


def theorem_2(_store: Store) -> Claim:
    """Theorem 2 on the linearized diagram."""
    printed = _formation_matrix(local=False)
    complete = _formation_matrix(local=True)
    centre = int(np.sum(np.abs(printed) < MARGIN))
    return Claim(
        claim="Theorem 2: Ā = I⊗A − L_k⊗Z − L_g⊗BΔ is Hurwitz for δ large enough, so the consensus error vanishes",
        verdict=verdict(complete.real.max() < -MARGIN, printed.real.max() < -MARGIN),
        evidence=(
            f"as printed (u_l = 0) Ā is not Hurwitz: {centre} of its {len(printed)} eigenvalues are 0, the motion of "
            "the "
            "formation as a whole, which no δ moves, and the relative modes lie on the imaginary axis (largest |Re| "
            f"{np.abs(printed.real).max():.0e} 1/s), since Δ has no velocity part. With the local LQR of Theorem 1 all "
            f"eigenvalues are at or left of {complete.real.max():.4f} 1/s; relative modes alone need δ_v > 0"
        ),
        source="Linearize of the quadrilateral's diagram, linear springs, δ = 1e4",
    )


def _formation_matrix(*, local: bool) -> NDArray[np.complex128]:
    """Eigenvalues of the linearized quadrilateral in formation at the goal, with or without the local LQR."""
    scenario = in_formation_at_goal(
        with_overrides(load_scenario("quadrilateral"), {"springs.law": "linear", "consensus.delta": 1e4})
    )
    diagram = build_diagram(scenario)
    context = diagram.CreateDefaultContext()
    if not local:
        for robot in range(resolve(scenario).robots):
            tracking = find_block(diagram, f"robot_{robot + 1}/tracking")
            parameters = tracking.GetMyMutableContextFromRoot(context).get_mutable_numeric_parameter(0)
            parameters.SetFromVector(np.zeros(8))
    linear = Linearize(diagram, context, InputPortSelection.kNoInput, OutputPortSelection.kNoOutput)
    return np.linalg.eigvals(linear.A())


def in_formation_at_goal(scenario: Scenario) -> Scenario:
    """The scenario with every robot at rest in its slot at the goal, without obstacles."""
    return with_overrides(
        scenario,
        {
            "aggregation.duration": 0.0,
            "robots.start": {"centre": list(scenario.transport.goal)},
            "avoidance.obstacles": [],
        },
    )


def drifting() -> Scenario:
    """The line in formation under consensus alone, as the proof of Theorem 2 has it, and moving."""
    return with_overrides(
        in_formation_at_goal(load_scenario("line")),
        {
            "tracking": {"kind": "none"},
            "consensus.delta": 1e4,
            "robots.velocity": list(DRIFT),
            "transport.duration": 10.0,
        },
    )


DRIFT = (0.1, 0.0)
"""Velocity of every robot at the start (m/s); chosen."""


def invariant_mean(store: Store) -> Claim:
    """The proof of Theorem 2: Σ u_g = 0, thus the mean state does not change."""
    moving = phase(store[drifting()], 1)
    total = float(np.abs(moving["control_force"].sum("robot")).max())
    mean = moving["position"].mean("robot")
    moved = float(np.linalg.norm(mean[-1] - mean[0]))
    duration = float(moving["time"][-1] - moving["time"][0])
    return Claim(
        claim="proof of Theorem 2: Σ u_g = 0, thus x̄ is invariant and ė = ẋ",
        verdict=HOLDS if moved < MARGIN else FAILS,
        evidence=(
            f"Σ u_g is {total:.1g} N throughout, but x̄ moves by {moved:.2f} m in {duration:g} s where the robots move "
            f"at {DRIFT[0]:g} m/s: with Σ u_g = 0 the mean velocity is invariant, and the mean position only where "
            "that is 0. The conclusion on e does not need it"
        ),
        source="line, consensus alone, δ = 1e4, moving",
    )


def lemmas(_store: Store) -> Claim:
    """Lemmas 1, 3 and 4 on the graphs of the study."""
    rng = np.random.default_rng(0)
    worst, second = 0.0, np.inf
    for name in TOPOLOGIES:
        channels = resolve(topology(name)).channels
        graph, laplacian = channels.graph, channels.laplacian
        first, *others = np.linalg.eigvalsh(laplacian)
        worst, second = max(worst, abs(first)), min(second, *others)
        x = rng.normal(size=len(laplacian))
        potential = 0.5 * sum(2 * (x[i] - x[j]) ** 2 for i, j in graphs.edges(graph))
        worst = max(worst, abs(x @ laplacian @ x - potential))
    return Claim(
        claim="Lemmas 1, 3 and 4: a connected graph has one zero eigenvalue, xᵀLx is the Laplacian potential (Eq. 1) "
        "and vanishes in agreement only",
        verdict=HOLDS if worst < 1e-12 and second > 0 else FAILS,
        evidence=(
            f"zero eigenvalues and Eq. 1 to {worst:.0e}; the smallest non-zero eigenvalue of all topologies is "
            f"{second:.3g}"
        ),
        source="the communication graphs of Fig. 22",
    )


def lemma_2(_store: Store) -> Claim:
    """Lemma 2 on the adjacency matrices: its premise."""
    definite = []
    for name in TOPOLOGIES:
        graph = resolve(topology(name)).channels.graph
        adjacency = np.diag(graphs.in_degrees(graph)) - graphs.laplacian(graph)
        low, *_, high = np.linalg.eigvalsh(adjacency)
        definite.append(low >= 0 or high <= 0)
    return Claim(
        claim="Lemma 2: null(Γ) = {x | xᵀΓx = 0} if and only if Γ is semi-definite, for the graph's adjacency matrix Γ",
        verdict=verdict(True, all(definite)),
        evidence=(
            f"true of symmetric matrices, but {sum(definite)} of the {len(definite)} adjacency matrices are "
            "semi-definite "
            "(with an edge the trace is 0 and the spectrum has both signs); the paper uses only γ_ij = γ_ji of it"
        ),
        source="the communication graphs of Fig. 22",
    )
