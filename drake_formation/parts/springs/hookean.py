"""Springs along the lines between robots (paper, Eq. 2)."""

from collections.abc import Iterator

import numpy as np
from pydantic import Field

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import NonNegative, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import BreakNumbers, RestNumbers, SpringLaw
from drake_formation.parts.registry import part
from drake_formation.systems.scalars import Scalar


def hookean_spring_force(
    dx: Scalar, dy: Scalar, dvx: Scalar, dvy: Scalar, stiffness: Scalar, damping: Scalar, hx: Scalar, hy: Scalar
) -> tuple[Scalar, Scalar]:
    """Force F_ij that a spring draws robot i back with, along the line between the robots (paper, Eq. 2).

    F_ij = (k (1 − r/d) + c ḋ/d) (q_i − q_j), with d = ‖q_i − q_j‖ and r = ‖h_i − h_j‖. The damper c ḋ is an
    extension; the paper's springs have none.

    Args:
        dx: position of robot i relative to robot j (m), x component of q_i − q_j.
        dy: its y component (m).
        dvx: velocity of robot i relative to robot j (m/s), x component.
        dvy: its y component (m/s).
        stiffness: k_ij (N/m).
        damping: c_ij (N s/m).
        hx: desired displacement h_i − h_j (m), x component.
        hy: its y component (m).

    Returns:
        Components of F_ij (N); the plant feels −F_ij.
    """
    distance = (dx * dx + dy * dy) ** 0.5
    rest_length = (hx * hx + hy * hy) ** 0.5
    approach = (dx * dvx + dy * dvy) / (distance * distance)
    tension = stiffness * (1.0 - rest_length / distance) + damping * approach
    return tension * dx, tension * dy


class Stiffness(Section):
    """Stiffness and damping of one spring."""

    stiffness: NonNegative = Field(
        default=1.45, description="k_ij (N/m), one for all or one an edge; published: 1.45 rubber, 3e4 steel"
    )
    damping: NonNegative = Field(default=0.0, description="c_ij (N s/m), one for all or one an edge; published: none")


class SpringNumbers(BreakNumbers, RestNumbers, Stiffness):
    """Stiffness and damping of one spring, where it is at rest, and when it breaks."""


class Spring(SpringLaw):
    """A spring that may be at rest elsewhere than between its robots in their slots."""

    Config = SpringNumbers

    def rest_length(self, distance: float) -> float:
        """The length given, or where the tension given is what the spring has between the slots: r = d − T/k (m)."""
        config = self.config
        if config.rest_length is not None:
            return float(config.rest_length)
        return distance - config.pre_tension / config.stiffness if config.pre_tension else distance

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether there is one length at which it is at rest, and that is above 0."""
        config = self.config
        if not config.pre_tension:
            return
        first, second = formation.springs.pairs[owner]
        distance = float(np.linalg.norm(formation.slots[first] - formation.slots[second]))
        value = shown(config.pre_tension)
        if config.rest_length is not None:
            yield Fault(("pre_tension",), "given together with rest_length", value, "one of the two")
        elif not config.stiffness:
            yield Fault(("pre_tension",), "a spring without stiffness has none", value, "0, or some stiffness")
        elif distance and config.pre_tension >= config.stiffness * distance:
            most = f"less than k_ij d_ij = {config.stiffness * distance:.4g} N"
            yield Fault(("pre_tension",), "the spring would be at rest at no length", value, most)


@part("spring", kind="hookean")
class Hookean(Spring):
    """Springs that act along the lines between robots (paper, Eq. 2); they leave the formation free to turn."""

    law = staticmethod(hookean_spring_force)
