"""A part: one box of the diagram in one file, with its configuration, its law, its block and its numbers."""

from collections.abc import Hashable, Iterator
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydrake.systems.framework import System

from drake_formation.config.errors import Fault
from drake_formation.config.values import Length, Positive, Section
from drake_formation.formation.formation import Formation
from drake_formation.sources import OWN

Array = NDArray[np.float64]
Numbers = tuple[Array, ...]
"""Numeric parameters of a block, in order of their indices."""


class PartFailedError(ArithmeticError):
    """A part that cannot go on in the middle of a run; the message says why.

    Attributes:
        robot: whose part, from 1.
        advice: what to try.
    """

    def __init__(self, message: str, robot: int, advice: str) -> None:
        super().__init__(message)
        self.robot = robot
        self.advice = advice


class Part:
    """What the diagram knows of a box; subclasses are registered by :func:`drake_formation.parts.part`.

    A part stands for one robot, edge or channel (its *owner*), or for the whole formation, as its role says. It holds
    what was configured for that owner; all else it takes from the formation.

    Attributes:
        role: name of its role, a key of :data:`drake_formation.parts.roles.ROLES`.
        kind: its name in scenarios.
        distribution: the package that brings it.
        Config: its fields, each with a description that says its unit; none by default. In scenarios a field of a
            robot's part may be one value for all, a list or a mapping; here it is one robot's.
        config: what was configured.
    """

    role: ClassVar[str]
    kind: ClassVar[str]
    distribution: ClassVar[str] = OWN
    Config: ClassVar[type[Section]] = Section

    def __init__(self, config: Any) -> None:
        self.config = config

    @classmethod
    def called(cls) -> str:
        """Its role, kind and where it comes from, as messages name it."""
        return f"{cls.role} {cls.kind!r} of {cls.distribution}"

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """What is wrong with the configuration in this formation; paths begin inside the part's section.

        Args:
            formation: where the part is.
            owner: index of the robot, edge or channel, 0 for the formation's own.
        """
        return iter(())

    def warnings(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """What can be run but may not be meant; as for :meth:`checks`, and asked of a sound formation only."""
        return iter(())

    @classmethod
    def has_checks(cls) -> bool:
        """Whether there is anything to check."""
        return cls.checks is not Part.checks

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """The block's numeric parameters, in order of their indices; none by default."""
        return ()

    def structure(self) -> Hashable:
        """What a new block is needed for when it changes: all that is configured and not a number."""
        return ()

    def layout(self, formation: Formation, owner: int) -> Hashable:  # noqa: ARG002
        """What of the formation, beyond its graphs, a new block is needed for when it changes; nothing by default."""
        return ()

    def ticks(self) -> tuple[tuple[float, float], ...]:
        """Period and offset (s) of the updates at which what it gives may jump; those of a field ``period``, if any."""
        period = getattr(self.config, "period", None)
        return () if period is None else ((float(period), 0.0),)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> System | None:
        """The block in double; it converts to AutoDiffXd and Expression.

        Its ports are named as the role says. Its numeric parameters are the given ones.

        Args:
            formation: where the part is.
            owner: as for :meth:`checks`.
            numbers: from :meth:`numbers`.
        """
        raise NotImplementedError

    def initial_state(self, formation: Formation, owner: int) -> Array | None:  # noqa: ARG002
        """The block's continuous state at the start; None where its default is right for every scenario."""
        return None

    def initial_discrete_state(self, formation: Formation, owner: int) -> Numbers | None:  # noqa: ARG002
        """The block's discrete state at the start, one array a group; None where its default is right for all."""
        return None


class RestNumbers(Section):
    """Where a spring is at rest, if not between its robots in their slots; at most one of the two may be given."""

    rest_length: Length | None = Field(
        default=None, description="r_ij (m), one for all or one an edge; published: the distance of the slots"
    )
    pre_tension: float = Field(
        default=0.0,
        description="T_ij (N), with which the spring draws robots in their slots together, or below 0 pushes them "
        "apart; one for all or one an edge; published: none",
    )


class BreakNumbers(Section):
    """When a spring breaks, if it may."""

    break_at_strain: Positive | None = Field(
        default=None,
        description="strain |d/r − 1| (1), longer or shorter, beyond which a spring breaks for good; one for all or "
        "one an edge; default: none",
    )
    break_at_force: Positive | None = Field(
        default=None,
        description="force ‖F_ij‖ (N) beyond which it does, likewise; one for all or one an edge; default: none",
    )


class SpringLaw(Part):
    """The law by which the carried object couples two robots; a part without a block, for plants carry it out.

    The fields of its configuration are numbers of an edge, and the law's arguments in the order of their declaration;
    those of :class:`RestNumbers`, if it has them, say where the spring is at rest instead, and those of
    :class:`BreakNumbers` when it breaks.
    """

    role = "spring"

    @staticmethod
    def law(dx: Any, dy: Any, dvx: Any, dvy: Any, *numbers: Any) -> tuple[Any, Any]:
        """Force with which the object draws robot i towards robot j.

        Args:
            dx: position of robot i relative to robot j (m), x component of q_i − q_j.
            dy: its y component (m).
            dvx: velocity of robot i relative to robot j (m/s), x component.
            dvy: its y component (m/s).
            numbers: the configured ones, then the desired displacement h_i − h_j (m), x and y component.

        Returns:
            Components of F_ij (N); the plant feels −F_ij.
        """
        raise NotImplementedError

    @classmethod
    def arguments(cls) -> list[str]:
        """The fields that are the law's arguments, in their order."""
        others = RestNumbers.model_fields.keys() | BreakNumbers.model_fields.keys()
        return [name for name in cls.Config.model_fields if name not in others]

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """The numbers of the edge that are the law's arguments."""
        return (np.array([getattr(self.config, name) for name in self.arguments()], dtype=float),)

    def rest_length(self, distance: float) -> float:
        """The length at which the spring is at rest (m), between slots at some distance (m): that, by default."""
        return distance
