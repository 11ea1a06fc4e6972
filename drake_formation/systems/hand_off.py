"""The hand-off: the moment at which the object is placed on the gathered robots."""

from typing import Any

from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.templates import block_template, in_double

# Drake knows periodic events only; a period longer than any run makes this one happen once.
NEVER_AGAIN = 1e12


@block_template("HandOff_", __name__)
def HandOff_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The switch as a template over double, AutoDiffXd and Expression; see :class:`HandOff`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A switch from aggregation (0) to transport (1) at which the integrator stops exactly.

        Output port: ``phase`` (size 1), the discrete state.
        """

        def _construct(self, time: float, *, converter: Any = None) -> None:
            """Make the switch.

            Args:
                time: when the object is placed (s).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (time,)
            self.time = time
            phase = self.DeclareDiscreteState(BasicVector_[T]([0.0]))
            self.DeclarePeriodicDiscreteUpdateEvent(NEVER_AGAIN, time, self._place_object)
            self.DeclareStateOutputPort("phase", phase)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _place_object(self, _context: Any, discrete_state: Any) -> None:
            discrete_state.set_value([T(1.0)])

    return Impl


HandOff = in_double(HandOff_)
