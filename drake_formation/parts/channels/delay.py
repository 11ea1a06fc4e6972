"""A channel that delays what is sent, and does nothing else to it."""

from collections.abc import Hashable
from typing import Any

import numpy as np
from pydantic import Field

from drake_formation.config.values import NonNegative, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.channels.channel import Channel
from drake_formation.parts.channels.delay_line import DelayLine
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part


@part("channel", kind="delay")
class Delay(Channel):
    """A pure delay, as in the theory of delay-differential equations; before the beginning all moved evenly."""

    class Config(Section):
        """How long it is, and how finely it is kept."""

        delay: NonNegative = Field(
            le=1e3, description="τ (s) from the robot that speaks to the one that hears; 0 is a wire"
        )
        pieces: int = Field(
            default=16, ge=1, le=1000, description="how many pieces of the past are kept, a cubic in each; chosen: 16"
        )

    @property
    def is_wire(self) -> bool:
        """Whether there is no delay."""
        return bool(self.config.delay == 0)

    @property
    def keeps_every(self) -> float:
        """Between two states that are kept (s)."""
        return float(self.config.delay / self.config.pieces)

    def structure(self) -> Hashable:
        """Delay and pieces, with which a block is made."""
        return self.config.delay, self.config.pieces

    def layout(self, formation: Formation, owner: int) -> Hashable:  # noqa: ARG002
        """When it keeps the state first (s): the beginning is one of the moments kept."""
        return formation.begin % self.keeps_every if self.config.delay else 0.0

    def initial_discrete_state(self, formation: Formation, owner: int) -> Numbers | None:
        """Before the beginning the speaker moved evenly, at the speed at which it starts."""
        if not self.config.delay:
            return None
        speaker = formation.channels.pairs[owner, 1]
        velocity = formation.start_velocities[speaker]
        back = np.linspace(-self.config.delay, 0.0, self.config.pieces + 1)[:, None]
        past = np.hstack([formation.starts[speaker] + back * velocity, np.tile(velocity, (len(back), 1))])
        return past.ravel(), np.array([formation.begin])

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The delay, or none where it is a wire."""
        past = self.initial_discrete_state(formation, owner)
        return DelayLine(self.keeps_every, self.layout(formation, owner), *past) if past else None
