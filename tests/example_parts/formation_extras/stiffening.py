"""A spring law: the farther from rest, the stiffer."""

from pydantic import Field

from drake_formation.config.values import NonNegative, Section
from drake_formation.parts import SpringLaw, part


@part("spring", kind="stiffening")
class Stiffening(SpringLaw):
    """A spring on displacements whose force grows with their cube."""

    class Config(Section):
        """Its numbers."""

        stiffness: NonNegative = Field(default=10.0, description="stiffness at rest (N/m)")
        cubic: NonNegative = Field(default=0.0, description="what the square of a displacement adds (N/m³)")

    @staticmethod
    def law(dx, dy, dvx, dvy, stiffness, cubic, hx, hy):
        """(k + c ‖s‖²) s of the displacement s from rest."""
        sx, sy = dx - hx, dy - hy
        tension = stiffness + cubic * (sx * sx + sy * sy)
        return tension * sx, tension * sy
