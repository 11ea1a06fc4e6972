"""Which springs and grips bear what they are loaded with."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from drake_formation.parts.part import SpringLaw
from drake_formation.systems.scalars import Scalar, at_least, at_most


class Bearing(Protocol):
    """Which of some springs or grips bear what they are loaded with; equal ones do by the same law."""

    def __call__(self, seen: Sequence[list[Scalar]], numbers: Sequence[Any]) -> list[Scalar]:
        """1 for each that bears it, else 0.

        Args:
            seen: what the block's input ports bring.
            numbers: the block's parameters, an array a group.
        """


@dataclass(frozen=True)
class SpringsBear:
    """Springs between robots, by their strain |d/r − 1| and their force ‖F_ij‖.

    It sees the states of all robots and, where springs may be let go, for each 1 while it is held, else 0. Its numbers
    are for each spring those of the law and where it is at rest, and [strain, force] (1, N), infinite for no bound.
    """

    law: type[SpringLaw]
    pairs: tuple[tuple[int, int], ...]
    may_be_let_go: bool

    def __call__(self, seen: Sequence[list[Scalar]], numbers: Sequence[Any]) -> list[Scalar]:
        """As for :class:`Bearing`; a spring that is let go bears nothing."""
        springs, bounds = (group.reshape(len(self.pairs), -1).tolist() for group in numbers)
        held = seen[-1] if self.may_be_let_go else [1.0] * len(self.pairs)
        result = []
        for (i, j), spring, (strain, force), holds in zip(self.pairs, springs, bounds, held, strict=True):
            dx, dy, dvx, dvy = (mine - its for mine, its in zip(seen[i], seen[j], strict=True))
            fx, fy = self.law.law(dx, dy, dvx, dvy, *spring)
            hx, hy = spring[-2:]
            share = ((dx * dx + dy * dy) / (hx * hx + hy * hy)) ** 0.5
            strained, pulled = at_least(share - 1.0, 1.0 - share), (fx * fx + fy * fy) ** 0.5
            result.append(at_most(holds * strained, strain) * at_most(holds * pulled, force))
        return result


@dataclass(frozen=True)
class GripsBear:
    """Grips of an object that is a body of its own, by their force.

    It sees what the object exerts on each robot (N). Its number is for each grip the force that it bears (N).
    """

    def __call__(self, seen: Sequence[list[Scalar]], numbers: Sequence[Any]) -> list[Scalar]:
        """As for :class:`Bearing`."""
        bounds = numbers[0].tolist()
        return [at_most((fx * fx + fy * fy) ** 0.5, bound) for (fx, fy), bound in zip(seen, bounds, strict=True)]
