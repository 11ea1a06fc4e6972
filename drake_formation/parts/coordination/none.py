"""No coordination: a robot does nothing about what it hears."""

from typing import Any

import numpy as np
from pydrake.systems.framework import LeafSystem_

from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.systems.templates import block_template, in_double


@block_template("NoForce_", __name__)
def NoForce_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The block as a template over double, AutoDiffXd and Expression; see :class:`NoForce`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A controller that exerts no force; it has no input ports. Output port: ``force`` (N, size 2)."""

        def _construct(self, *, converter: Any = None) -> None:
            """Make the controller.

            Args:
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.kind = "none"  # it computes nothing
            self._nothing = np.array([T(0.0), T(0.0)])
            self.DeclareVectorOutputPort("force", 2, self._calc_force, {self.nothing_ticket()})

        def _construct_copy(self, _other: Any, converter: Any = None) -> None:
            Impl._construct(self, converter=converter)

        def _calc_force(self, _context: Any, output: Any) -> None:
            output.SetFromVector(self._nothing)

    return Impl


NoForce = in_double(NoForce_)


@part("coordination", kind="none")
class NoCoordination(Part):
    """No coordination, the first baseline: robots track their references each for itself."""

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """A controller without force."""
        return NoForce()
