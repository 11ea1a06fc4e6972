"""The best weights for the channels of a given graph, by semidefinite programming.

They would be the paper's γ_ij (Eq. 15), which a scenario's channels all have at 1: with other weights the spectrum of
the weighted Laplacian L(γ) = Σ γ_ij b_ij b_ijᵀ takes the place of the graph's own.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.formation import graphs

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FastestWeights:
    """Weights with the largest algebraic connectivity for a total of 1.

    Attributes:
        edges: who talks, robots from 1.
        weights: γ of every edge, none negative.
        connectivity: second-smallest eigenvalue λ₂ of the weighted Laplacian.
        uniform_connectivity: λ₂ with the same weight for every edge.
    """

    edges: tuple[graphs.Edge, ...]
    weights: Array
    connectivity: float
    uniform_connectivity: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values by name; weights have no unit."""
        return {
            "edges": [list(edge) for edge in self.edges],
            "weights": self.weights.tolist(),
            "connectivity": self.connectivity,
            "uniform_connectivity": self.uniform_connectivity,
        }


@dataclass(frozen=True)
class AveragingWeights:
    """Weights with which agreement is reached in the fewest steps of x ← x − L(γ) x.

    Attributes:
        edges: who talks, robots from 1.
        weights: γ of every edge; some may be negative.
        factor: what is left of a disagreement after every step, at worst: ‖I − L(γ) − 11ᵀ/N‖.
        constant_factor: the same with the best weight that is equal for all edges, 2/(λ₂ + λ_N).
        metropolis_factor: the same with Metropolis weights 1/(1 + max(d_i, d_j)).
        maximum_degree_factor: the same with the weight 1/(1 + max d) on all edges.
    """

    edges: tuple[graphs.Edge, ...]
    weights: Array
    factor: float
    constant_factor: float
    metropolis_factor: float
    maximum_degree_factor: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values by name; weights and factors have no unit."""
        return {
            "edges": [list(edge) for edge in self.edges],
            "weights": self.weights.tolist(),
            "factor": self.factor,
            "constant_factor": self.constant_factor,
            "metropolis_factor": self.metropolis_factor,
            "maximum_degree_factor": self.maximum_degree_factor,
        }


def fastest_weights(graph: nx.Graph) -> FastestWeights:
    """Weights of total 1, none negative, that make λ₂ largest (Fiedler 1990; Ghosh, Boyd 2006).

    Maximize s subject to Σ γ_ij = 1, γ ≥ 0 and Pᵀ L(γ) P ⪰ s I, where the columns of P span the disagreements.

    Args:
        graph: who talks, robots from 0.

    Raises:
        IllPosedError: the graph is not connected, or there is one robot only.
    """
    pieces = _pieces(graph)
    weights = _solved(pieces, lambda program, unknown: _largest_connectivity(program, unknown, pieces))
    weights = np.maximum(weights, 0.0)
    weights = weights / weights.sum()
    even = np.full(len(weights), 1 / len(weights))
    return FastestWeights(_numbered(graph), weights, _spectrum(pieces, weights)[0], _spectrum(pieces, even)[0])


def fastest_averaging(graph: nx.Graph) -> AveragingWeights:
    """Symmetric weights for the fastest linear averaging (Xiao, Boyd 2004).

    Minimize s subject to −s I ⪯ Pᵀ (I − L(γ)) P ⪯ s I, where the columns of P span the disagreements.

    Args:
        graph: who talks, robots from 0.

    Raises:
        IllPosedError: the graph is not connected, or there is one robot only.
    """
    pieces = _pieces(graph)
    weights = _solved(pieces, lambda program, unknown: _smallest_factor(program, unknown, pieces))
    degrees = dict(graph.degree)
    metropolis = np.array([1 / (1 + max(degrees[i], degrees[j])) for i, j in graphs.edges(graph)])
    largest_degree = np.full(len(weights), 1 / (1 + max(degrees.values())))
    eigenvalues = _spectrum(pieces, np.ones(len(weights)))
    constant = np.full(len(weights), 2 / (eigenvalues[0] + eigenvalues[-1]))
    return AveragingWeights(
        _numbered(graph), weights, *(_factor(pieces, each) for each in (weights, constant, metropolis, largest_degree))
    )


def weighted_laplacian(graph: nx.Graph, weights: Array) -> Array:
    """L(γ) for a weight of every edge, in the order of :func:`graphs.edges`, shape (N, N)."""
    incidence = _incidence(graph)
    result: Array = incidence @ np.diag(weights) @ incidence.T
    return result


def _incidence(graph: nx.Graph) -> Array:
    edges = graphs.edges(graph)
    result = np.zeros((graph.number_of_nodes(), len(edges)))
    for k, (i, j) in enumerate(edges):
        result[i, k], result[j, k] = 1.0, -1.0
    return result


def _pieces(graph: nx.Graph) -> Array:
    """Pᵀ b bᵀ P of every edge, shape (edges, N − 1, N − 1)."""
    robots = graph.number_of_nodes()
    if robots < 2 or not nx.is_connected(graph):
        raise IllPosedError(
            f"weights for agreement take a connected graph of at least two robots; this one has {robots} in "
            f"{nx.number_connected_components(graph)} parts"
        )
    # The vectors across (1, …, 1): all but the first column of an orthogonal matrix that begins with it.
    disagreements = np.linalg.qr(np.column_stack([np.ones(robots), np.eye(robots)[:, 1:]]))[0][:, 1:]
    projected = disagreements.T @ _incidence(graph)
    result: Array = np.einsum("ik,jk->kij", projected, projected)
    return result


def _solved(pieces: Array, posed: Callable[[Any, Any], None]) -> Array:
    """Weights from a program posed on them."""
    from pydrake.solvers import ClarabelSolver, MathematicalProgram  # slow to import

    program = MathematicalProgram()
    weights = program.NewContinuousVariables(len(pieces), "weight")
    posed(program, weights)
    result = ClarabelSolver().Solve(program)
    if not result.is_success():
        raise IllPosedError(f"the semidefinite program was not solved: {result.get_solution_result()}")
    solution: Array = np.asarray(result.GetSolution(weights), dtype=float)
    return solution


def _largest_connectivity(program: Any, weights: Any, pieces: Array) -> None:
    (level,) = program.NewContinuousVariables(1, "connectivity")
    unit = np.eye(pieces.shape[1])
    program.AddLinearMatrixInequalityConstraint([0 * unit, *pieces, -unit], [*weights, level])
    program.AddLinearEqualityConstraint(np.ones((1, len(weights))), [1.0], weights)
    program.AddBoundingBoxConstraint(0.0, np.inf, weights)
    program.AddLinearCost(-level)


def _smallest_factor(program: Any, weights: Any, pieces: Array) -> None:
    (level,) = program.NewContinuousVariables(1, "factor")
    unit = np.eye(pieces.shape[1])
    program.AddLinearMatrixInequalityConstraint([unit, *-pieces, unit], [*weights, level])
    program.AddLinearMatrixInequalityConstraint([-unit, *pieces, unit], [*weights, level])
    program.AddLinearCost(level)


def _spectrum(pieces: Array, weights: Array) -> list[float]:
    """Eigenvalues of the weighted Laplacian but the first, which is 0; ascending."""
    values: list[float] = np.linalg.eigvalsh(np.tensordot(weights, pieces, axes=1)).tolist()
    return values


def _factor(pieces: Array, weights: Array) -> float:
    return max(abs(1 - value) for value in _spectrum(pieces, weights))


def _numbered(graph: nx.Graph) -> tuple[graphs.Edge, ...]:
    return tuple((i + 1, j + 1) for i, j in graphs.edges(graph))
