"""Which motions the carried object resists: the exact linearization of its springs against the paper's (5).

A spring along the line between two robots (paper, Eq. 2) linearizes to rank 1, k n nᵀ with n along the line; the
paper's (5) reads k I, which resists motion across the line too. What springs along lines cannot resist is counted by
the rigidity matrix of the framework (Asimow and Roth, 1978): two translations and one rotation if it is rigid, more
if it can be sheared without stretching a spring.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import Array, LinearFormation, linearize
from drake_formation.analysis.linear.motion_subspaces import ROUNDING, rotation, spring_stiffness
from drake_formation.analysis.stability.held_shape import stiff_springs
from drake_formation.formation.rigidity import rigid_rank, rigidity_rank
from drake_formation.parts.springs.hookean import Hookean
from drake_formation.parts.springs.linear import Linear
from drake_formation.scenario import Scenario, with_overrides


@dataclass(frozen=True)
class SpringLinearization:
    """The object's stiffness under both laws, about the formation at rest.

    Attributes:
        law: the scenario's, ``hookean`` (exact) or ``linear`` (the paper's Eq. 5).
        springs: number of springs with stiffness.
        rank: rank of their rigidity matrix, the number of independent changes of length.
        mechanisms: independent changes of shape that stretch no spring; 0 for a rigid framework.
        exact: stiffness matrix of springs along lines, from Drake (N/m), shape (2N, 2N).
        linear: stiffness matrix of the paper's law, from Drake (N/m), shape (2N, 2N).
        exact_free: motions that the exact law leaves free: translations, rotation and mechanisms.
        linear_free: motions that the paper's law leaves free: one translation per connected piece and axis.
        exact_rotation: how springs along lines resist a rotation as a rigid body (N/m); not at all.
        linear_rotation: how the paper's law resists it (N/m).
    """

    law: str
    springs: int
    rank: int
    mechanisms: int
    exact: Array
    linear: Array
    exact_free: int
    linear_free: int
    exact_rotation: float
    linear_rotation: float

    @property
    def rigid(self) -> bool:
        """Whether springs along lines hold the shape."""
        return self.mechanisms == 0

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "law": self.law,
            "springs": self.springs,
            "rigidity_rank": self.rank,
            "mechanisms": self.mechanisms,
            "rigid": self.rigid,
            "exact": {
                "stiffness_n_per_m": np.linalg.eigvalsh(self.exact).tolist(),
                "free_motions": self.exact_free,
                "rotation_stiffness_n_per_m": self.exact_rotation,
            },
            "linear": {
                "stiffness_n_per_m": np.linalg.eigvalsh(self.linear).tolist(),
                "free_motions": self.linear_free,
                "rotation_stiffness_n_per_m": self.linear_rotation,
            },
        }


def spring_linearization(formation: LinearFormation) -> SpringLinearization:
    """Linearize the object under both spring laws.

    Raises:
        IllPosedError: the formation is one robot or has no spring with stiffness.
    """
    scenario = formation.scenario
    if formation.resolved.law not in (Hookean, Linear):
        raise IllPosedError(
            f"the object's springs act by {formation.resolved.law.kind!r}; what is compared are the paper's two laws"
        )
    stiff = stiff_springs(formation.resolved)
    if not stiff:
        raise IllPosedError("the object has no springs with stiffness: give springs.graph edges and springs.stiffness")
    slots = formation.resolved.slots
    rank = rigidity_rank(slots, stiff)
    exact, linear = (_stiffness(scenario, law) for law in ("hookean", "linear"))
    turning = rotation(slots)
    return SpringLinearization(
        law=formation.resolved.law.kind,
        springs=len(stiff),
        rank=rank,
        mechanisms=rigid_rank(formation.robots) - rank,
        exact=exact,
        linear=linear,
        exact_free=_nullity(exact),
        linear_free=_nullity(linear),
        exact_rotation=_along(turning, exact),
        linear_rotation=_along(turning, linear),
    )


def _nullity(stiffness: Array) -> int:
    values = np.linalg.eigvalsh(stiffness)
    return int(np.sum(values <= ROUNDING * values[-1]))


def _along(direction: Array, stiffness: Array) -> float:
    """Stiffness along a direction of unit length (N/m); what rounding leaves of a zero is zero."""
    value = float(direction @ stiffness @ direction)
    return value if value > ROUNDING * np.abs(stiffness).max() else 0.0


def _stiffness(scenario: Scenario, law: str) -> Array:
    """The object's stiffness under a law, from Drake; what rounding leaves of a zero is set to zero."""
    matrix = spring_stiffness(linearize(with_overrides(scenario, {"springs.law": law})))
    result: Array = np.where(np.abs(matrix) > ROUNDING * np.abs(matrix).max(), matrix + matrix.T, 0.0) / 2
    return result
