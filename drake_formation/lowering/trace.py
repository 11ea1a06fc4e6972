"""What a block computes, traced with Drake's symbolic scalar."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from pydrake.symbolic import Expression, Variable
from pydrake.systems.framework import Context, LeafSystem, PortDataType

from drake_formation.lowering.declared import recorded, require_known_events
from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.expressions import Leaf

DERIVATIVES, UPDATE = -1, -2
"""What stands for the time derivatives, and for the periodic update, where else the index of an output port stands."""

Sizes = tuple[tuple[int, ...], int, tuple[int, ...], tuple[int, ...]]
"""Sizes of a block's inputs (−1: abstract), continuous state, discrete groups and numeric parameter groups."""


@dataclass(frozen=True)
class Symbols:
    """A variable for every number that a block of some sizes can read."""

    time: Expression
    inputs: list[Any]
    state: Any
    discrete: list[Any]
    parameters: list[Any]
    leaf_of: dict[int, Leaf]


class SymbolTable:
    """Symbols by the sizes of a block, so that blocks of the same sizes are traced with the same symbols.

    They are made in one order for all: Drake sorts expressions by the age of their variables, and terms that differ
    only in their port or parameter must be sorted alike.
    """

    def __init__(self) -> None:
        self._symbols: dict[Sizes, Symbols] = {}

    def of(self, sizes: Sizes) -> Symbols:
        """Symbols for the blocks of some sizes."""
        if sizes not in self._symbols:
            self._symbols[sizes] = _make_symbols(*sizes)
        return self._symbols[sizes]


def _make_symbols(
    inputs: tuple[int, ...], state: int, discrete: tuple[int, ...], parameters: tuple[int, ...]
) -> Symbols:
    leaf_of: dict[int, Leaf] = {}

    def group(space: str, number: int, size: int) -> Any:
        variables = [Variable(f"{space}_{number}_{index}") for index in range(size)]
        leaf_of.update({v.get_id(): Leaf(space, number, index) for index, v in enumerate(variables)})
        return np.array([Expression(variable) for variable in variables], dtype=object)

    return Symbols(
        time=group("time", 0, 1)[0],
        state=group("state", 0, state),
        discrete=[group("discrete", k, size) for k, size in enumerate(discrete)],
        inputs=[group("input", k, size) for k, size in enumerate(inputs)],
        parameters=[group("parameter", k, size) for k, size in enumerate(parameters)],
        leaf_of=leaf_of,
    )


class TracedBlock:
    """A block in symbols.

    Args:
        path: its place in the diagram, such as ``robot_1/plant``.
        block: the block.
        symbols: where to take the symbols from.
    """

    def __init__(self, path: str, block: LeafSystem, symbols: SymbolTable) -> None:
        self.path = path
        self.block = block
        context = block.CreateDefaultContext()
        self.sizes: Sizes = (
            tuple(_vector_size(block.get_input_port(k)) for k in range(block.num_input_ports())),
            context.num_continuous_states(),
            tuple(
                context.get_discrete_state().get_vector(k).size() for k in range(context.num_discrete_state_groups())
            ),
            tuple(context.get_numeric_parameter(k).size() for k in range(context.num_numeric_parameter_groups())),
        )
        self._symbols = symbols

    @property
    def symbols(self) -> Symbols:
        """The symbols it is traced with."""
        return self._symbols.of(self.sizes)

    def trace(self, function: int) -> list[Any]:
        """Expressions of an output port, of the time derivatives or of the discrete state after its update.

        Args:
            function: index of the output port, ``DERIVATIVES`` or ``UPDATE``.

        Raises:
            LoweringError: Drake or the block's own code cannot do that in symbols.
        """
        system, context = self._symbolic
        if function == UPDATE:
            context = self._context_of(system)  # another one would know the update already, and not carry it out
        if function not in (DERIVATIVES, UPDATE) and _vector_size(system.get_output_port(function)) < 0:
            raise LoweringError(self.path, "an output port of it that is needed is abstract")
        try:
            if function == DERIVATIVES:
                values = system.EvalTimeDerivatives(context).CopyToVector()
            elif function == UPDATE:
                after = system.EvalUniquePeriodicDiscreteUpdate(context)
                values = np.concatenate([after.get_vector(k).CopyToVector() for k in range(after.num_groups())])
            else:
                values = system.get_output_port(function).Eval(context)
        except Exception as error:
            raise LoweringError(self.path, f"its code does not run in symbols: {_reason(error)}") from error
        return list(np.ravel(values))

    def require_known_events(self) -> None:
        """Refuse events that a compiled run would leave out; the block, which is of Python's, is converted for that.

        Raises:
            LoweringError: there are such events, or the block does not convert, so that they cannot be known.
        """
        _, declared = self._converted
        require_known_events(self.path, self.block, declared)

    @cached_property
    def _converted(self) -> tuple[Any, list[str]]:
        """The block in symbols, and which events it declared."""
        try:
            with recorded() as declared:
                return self.block.ToSymbolic(), declared
        except Exception as error:
            raise LoweringError(self.path, f"it does not convert to Drake's symbolic scalar: {error}") from error

    @cached_property
    def _symbolic(self) -> tuple[Any, Context]:
        system, _ = self._converted
        return system, self._context_of(system)

    def _context_of(self, system: Any) -> Context:
        """A Context of the block in symbols that holds a symbol for every number."""
        context = system.CreateDefaultContext()
        symbols = self.symbols
        context.SetTime(symbols.time)
        for k, values in enumerate(symbols.inputs):
            if self.sizes[0][k] >= 0:
                system.get_input_port(k).FixValue(context, values)
        if self.sizes[1]:
            context.SetContinuousState(symbols.state)
        for k, values in enumerate(symbols.discrete):
            context.SetDiscreteState(k, values)
        for k, values in enumerate(symbols.parameters):
            context.get_mutable_numeric_parameter(k).SetFromVector(values)
        return context


CHOICE = (
    "it asks whether an expression is true, as `if`, `and`, `max`, `np.maximum` and `np.clip` do; write "
    "pydrake.symbolic's `if_then_else`, `max` and `min`, or the functions of drake_formation.systems.scalars, which "
    "take floats too"
)
ADVICE = {
    "__bool__": CHOICE,
    "truth value": CHOICE,
    "must be real number": "it calls a function of `math`, which takes floats alone; write NumPy's or pydrake.math's",
    "object arrays must be copied": "it reads a vector by `value()`; `CopyToVector()` is what every scalar has",
    "TrajectorySource": "a trajectory's pieces are no symbols; play it by "
    "drake_formation.parts.references.trajectory.TrajectoryReference, which takes the numbers of `trajectory_tables`",
}
"""What is wrong and what to write instead, by what is said when a block asks of symbols what they cannot do."""


def _reason(error: Exception) -> str:
    return next((advice for words, advice in ADVICE.items() if words in str(error)), str(error))


def _vector_size(port: Any) -> int:
    return int(port.size()) if port.get_data_type() == PortDataType.kVectorValued else -1
