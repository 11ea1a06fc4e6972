"""Springs and grips that break for good: what holds the object is looked at again and again."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.values import Positive, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.objects.bearing import Bearing, GripsBear, SpringsBear
from drake_formation.parts.part import Array, Numbers
from drake_formation.systems.templates import block_template, in_double

BOUNDS = ("break_at_strain", "break_at_force")
"""What a spring bears, by the fields that say so."""


class LookNumbers(Section):
    """How often what holds the object is looked at."""

    look_every: Positive = Field(
        default=1e-3,
        description="how often (s), from the hand-off on, it is looked at whether a spring or grip breaks, if any may: "
        "nothing shorter is seen; chosen: 1 ms",
    )


@block_template("Breaking_", __name__)
def Breaking_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The block as a template over double, AutoDiffXd and Expression; see :class:`Breaking`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Springs or grips, each of which acts until it is found loaded with more than it bears, and never again.

        Input ports: what the law that judges them sees. Output ports: ``intact``, for each 1 until it breaks and 0 from
        then on; ``broken_at``, for each when that was (s), 0 until then; and shares of ``intact`` as others want them.
        Both are discrete state, brought up to date periodically. Parameters: the law's groups.
        """

        def _construct(
            self,
            bearing: Bearing,
            inputs: Mapping[str, int],
            every: float,
            first: float,
            numbers: Sequence[ArrayLike],
            count: int,
            shares: Mapping[str, Sequence[int]],
            *,
            converter: Any = None,
        ) -> None:
            """Make the block.

            Args:
                bearing: which bear their load.
                inputs: size of each input port by its name.
                every: how often it looks (s).
                first: when it looks first (s).
                numbers: what the law computes with, by group.
                count: of the springs or grips.
                shares: further output ports, by their names: which of them, from 0, each has.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (bearing, inputs, every, first, numbers, count, shares)
            self.kind = bearing, tuple(inputs), every, first, tuple((k, tuple(v)) for k, v in shares.items())
            self._bearing = bearing
            self._seen = [self.DeclareVectorInputPort(name, size) for name, size in inputs.items()]
            self._groups = range(len(numbers))
            for group in numbers:
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            intact = self.DeclareDiscreteState(BasicVector_[T](np.ones(count)))
            broken_at = self.DeclareDiscreteState(count)
            self.DeclarePeriodicDiscreteUpdateEvent(every, first, self._look)
            self.DeclareStateOutputPort("intact", intact)
            self.DeclareStateOutputPort("broken_at", broken_at)
            for name, share in shares.items():
                self.DeclareVectorOutputPort(name, len(share), self._calc_share(list(share)), {self.xd_ticket()})

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _look(self, context: Any, held: Any) -> None:
            seen = [port.Eval(context).tolist() for port in self._seen]
            numbers = [context.get_numeric_parameter(k).CopyToVector() for k in self._groups]
            intact, broken_at = (context.get_discrete_state(k).CopyToVector().tolist() for k in (0, 1))
            bear, now = self._bearing(seen, numbers), context.get_time()
            held.set_value(0, np.array([before * bears for before, bears in zip(intact, bear, strict=True)]))
            times = zip(broken_at, intact, bear, strict=True)
            held.set_value(1, np.array([at + before * (1.0 - bears) * now for at, before, bears in times]))

        def _calc_share(self, share: list[int]) -> Any:
            def calc(context: Any, output: Any) -> None:
                output.SetFromVector(context.get_discrete_state(0).CopyToVector()[share])

            return calc

    return Impl


Breaking = in_double(Breaking_)


def breaks(formation: Formation) -> bool:
    """Whether any spring or grip may break; found out once for a formation."""
    if "breaks" not in formation.kept:
        formation.kept["breaks"] = bool(np.isfinite(_bounds(formation)).any())
    found: bool = formation.kept["breaks"]
    return found


def looks_every(formation: Formation) -> float:
    """How often what holds the object is looked at (s); infinite where nothing may break."""
    return float(formation.parts["object"][0].config.look_every) if breaks(formation) else float("inf")


def breaking_numbers(formation: Formation) -> Numbers:
    """What the block of a formation's springs or grips computes with."""
    if formation.has_body:
        return (_bounds(formation),)
    edges = range(len(formation.springs.pairs))
    law = np.array([formation.parts["spring"][edge].numbers(formation, edge)[0] for edge in edges])
    first, second = formation.springs.pairs.T
    apart = (formation.slots[first] - formation.slots[second]) * formation.elongations[:, None]
    return np.column_stack([law, apart]), _bounds(formation)


def breaking_block(formation: Formation, numbers: Numbers) -> Any:
    """The block of a formation's springs or grips.

    Its input ports are ``state_i`` of every robot, and ``whole`` where springs may be let go; or ``grip_force_i`` of
    every robot. Springs have the output ports ``intact_i`` of every robot that has any, in its order.
    """
    every = looks_every(formation)
    first = formation.hand_off + every
    robots = range(formation.robots)
    if formation.has_body:
        seen = {f"grip_force_{i + 1}": 2 for i in robots}
        return Breaking(GripsBear(), seen, every, first, numbers, formation.robots, {})
    pairs = tuple((i, j) for i, j in formation.springs.pairs.tolist())
    let_go = "whole" in formation.signals
    seen = {f"state_{i + 1}": 4 for i in robots} | ({"whole": len(pairs)} if let_go else {})
    shares = {f"intact_{i + 1}": its for i in robots if (its := formation.springs.incident(i))}
    return Breaking(SpringsBear(formation.law, pairs, let_go), seen, every, first, numbers, len(pairs), shares)


def _bounds(formation: Formation) -> Array:
    """What each spring bears, [strain, force] (1, N), or each grip (N); infinite for no bound."""
    if formation.has_body:
        (carried,) = formation.parts["object"]
        return np.full(formation.robots, _bound(carried, "grip_strength"))
    rows = [[_bound(part, name) for name in BOUNDS] for part in formation.parts["spring"]]
    return np.array(rows, dtype=float).reshape(-1, 2)


def _bound(part: Any, name: str) -> float:
    bound = getattr(part.config, name, None)
    return float("inf") if bound is None else float(bound)
