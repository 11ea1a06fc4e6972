"""A block is one template over Drake's scalars."""

import sys

import numpy as np
from pydrake.autodiffutils import AutoDiffXd
from pydrake.symbolic import Expression
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.templates import block_template, in_double


@block_template("Doubled_", __name__)
def Doubled_(T):  # noqa: N802
    class Impl(LeafSystem_[T]):
        def _construct(self, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self._u = self.DeclareVectorInputPort("u", 1)
            self.DeclareVectorOutputPort("y", BasicVector_[T](1), self._double)

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, converter=converter)

        def _double(self, context, output):
            output.SetFromVector(2.0 * self._u.Eval(context))

    return Impl


def doubled(system, value):
    context = system.CreateDefaultContext()
    system.get_input_port().FixValue(context, np.array([value]))
    return system.get_output_port().Eval(context)[0]


def test_it_lives_in_the_module_that_it_was_told():
    assert Doubled_[None].__module__ == __name__
    assert hasattr(sys.modules[__name__], Doubled_[None].__name__)


def test_it_converts_to_all_scalars():
    system = Doubled_[None]()
    assert doubled(system, 3.0) == 6.0
    assert doubled(system.ToAutoDiffXd(), AutoDiffXd(3.0, [1.0])).derivatives()[0] == 2.0
    assert doubled(system.ToSymbolic(), Expression(3.0)).Evaluate() == 6.0


def test_the_default_is_in_double():
    assert type(in_double(Doubled_)()) is Doubled_[float]
