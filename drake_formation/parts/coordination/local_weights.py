"""The weights by which coordination holds a robot to where it should be, as the local LQR does (paper, Eqs. 11-12)."""

from pydantic import Field

from drake_formation.config.values import CostMatrix, Section
from drake_formation.parts.tracking.lqr import Lqr


class LocalWeights(Section):
    """Weights of an LQR about a place that moves with others."""

    Q: CostMatrix = Field(
        default=1.0,
        description="state cost (1/m², s²/m²), 4 x 4: a number times I, a diagonal or a matrix; chosen: as the paper's",
    )
    R: CostMatrix = Field(
        default=1.0,
        description="input cost (1/N²), 2 x 2: a number times I, a diagonal or a matrix; chosen: as the paper's",
    )

    @property
    def regulator(self) -> Lqr:
        """The local LQR of these weights."""
        return Lqr(Lqr.Config(Q=self.Q, R=self.R))
