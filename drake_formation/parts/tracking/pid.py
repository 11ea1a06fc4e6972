"""The local controller that industry knows best: proportional, integral and derivative action."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from pydantic import Field

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import NonNegative, Positive
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.integral_controller import IntegralController, Windup, release_matrix


@part("tracking", kind="pid")
class Pid(Part):
    """A PID controller for each axis: u = −(k_p e + k_i ∫ e dt + k_d ė).

    The poles of one robot alone are the roots of m s³ + k_d s² + k_p s + k_i (Åström & Hägglund 2006, Sec. 4.4).
    """

    class Config(Windup):
        """Its gains."""

        kp: Positive = Field(default=1.0, description="proportional gain k_p (N/m); chosen: the paper's LQR of 40 kg")
        ki: NonNegative = Field(default=0.05, description="integral gain k_i (N/(m s)); chosen: 0.05")
        kd: Positive = Field(default=9.0, description="derivative gain k_d (N s/m); chosen: the paper's LQR of 40 kg")
        feed_forward: bool = Field(
            default=False, description="add m_i a_r, the force that the reference's acceleration takes; chosen: none"
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether one robot alone is stable, by Routh and Hurwitz: m k_i < k_p k_d."""
        config, mass = self.config, float(formation.masses[owner])
        if mass * config.ki >= config.kp * config.kd:
            message = f"unstable with a robot of {mass:g} kg"
            most = config.kp * config.kd / mass
            yield Fault(("ki",), message, shown(config.ki), f"below kp kd / mass = {most:g} N/(m s)")

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The gain, the mass in the feed-forward, the slot, and what its anti-windup takes."""
        config = self.config
        gain = np.kron([config.kp, config.kd, config.ki], np.eye(2))
        inertia = formation.masses[owner] if config.feed_forward else 0.0
        release = release_matrix(formation, owner, gain, config.anti_windup)
        return gain, np.array([inertia]), formation.slots[owner], *release

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The controller."""
        return IntegralController(*numbers)
