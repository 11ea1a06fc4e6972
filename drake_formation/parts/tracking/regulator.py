"""What the linear quadratic regulators of one robot have in common."""

from collections.abc import Iterator
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drake_formation.config.errors import Fault
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part

Array = NDArray[np.float64]


class Regulator(Part):
    """A gain designed by Drake for a robot's mass from weights Q and R, and the mass in a feed-forward, if wanted."""

    designed_from = "Q, R and masses"
    """What must not be of too different sizes for Drake to find a gain."""

    def weight_faults(self) -> Iterator[Fault]:
        """What is wrong with the weights by themselves."""
        raise NotImplementedError

    def stabilizes(self, mass: float) -> bool:
        """Whether Drake finds a gain for a mass (kg) that brings the robot to its set point."""
        raise NotImplementedError

    def gain(self, mass: float) -> Array:
        """The gain for a mass (kg), one row an axis."""
        raise NotImplementedError

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether the weights give a gain that brings the robot to its set point."""
        yield from self._faults
        mass = float(formation.masses[owner])
        # Weights that are sound one by one may still be too far apart for Drake to solve (paper, Eq. 12).
        if not self._faults and not self.stabilizes(mass):
            message = f"Drake finds no stabilizing gain for a robot of {mass:g} kg"
            yield Fault((), message, allowed=f"{self.designed_from} of less different sizes")

    @cached_property
    def _faults(self) -> tuple[Fault, ...]:
        """Of the weights; robots that are alike are one part, which looks once."""
        return tuple(self.weight_faults())

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The gain, the mass in the feed-forward, and the slot."""
        mass = float(formation.masses[owner])
        return self.gain(mass), np.array([mass if self.config.feed_forward else 0.0]), formation.slots[owner]
