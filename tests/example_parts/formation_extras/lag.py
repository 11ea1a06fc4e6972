"""A channel with state: what is heard lags behind what is sent."""

import numpy as np
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.values import Positive, Section
from drake_formation.parts import Part, part
from drake_formation.systems.templates import block_template, in_double


@block_template("LagChannel_", __name__)
def LagChannel_(T):  # noqa: N802
    """The channel as a template over double, AutoDiffXd and Expression."""

    class Impl(LeafSystem_[T]):
        """ẏ = (u − y)/τ from ``sent`` to ``received``; parameter 0 is τ (s)."""

        def _construct(self, time_constant, start, *, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (time_constant, start)
            self.kind = "lag"
            self._sent = self.DeclareVectorInputPort("sent", 4)
            self.DeclareNumericParameter(BasicVector_[T](time_constant))
            self.DeclareContinuousState(BasicVector_[T](start))
            self.DeclareVectorOutputPort("received", 4, self._calc, {self.xc_ticket(), self.time_ticket()})

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc(self, context, output):
            output.SetFromVector(context.get_continuous_state_vector().CopyToVector())

        def DoCalcTimeDerivatives(self, context, derivatives):  # noqa: N802
            (time_constant,) = context.get_numeric_parameter(0).CopyToVector()
            state = context.get_continuous_state_vector().CopyToVector()
            derivatives.SetFromVector((self._sent.Eval(context) - state) / time_constant)

    return Impl


LagChannel = in_double(LagChannel_)


@part("channel", kind="lag")
class Lag(Part):
    """A first-order lag."""

    class Config(Section):
        """How slow."""

        time_constant: Positive = Field(default=0.05, description="time constant τ (s)")

    def numbers(self, formation, owner):
        """The time constant."""
        return (np.array([self.config.time_constant]),)

    def initial_state(self, formation, owner):
        """The state that the speaker starts in, as if it had been sent for ever."""
        return formation.start_state(formation.channels.pairs[owner, 1])

    def block(self, formation, owner, numbers):
        """The channel."""
        return LagChannel(*numbers, self.initial_state(formation, owner))
