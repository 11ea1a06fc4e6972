"""Robots without a local controller, for laws that are the whole control; called at import, once a session."""

from drake_formation.config.values import Section
from drake_formation.parts import Part, kinds, part, register
from drake_formation.parts.tracking.controller import TrackingController


def no_force(error, acceleration):
    return 0.0 * error[0], 0.0 * error[1]


@part("tracking", kind="none")
class NoTracking(Part):
    """No force."""

    class Config(Section):
        """Nothing."""

    def numbers(self, formation, owner):
        return (formation.slots[owner],)

    def block(self, formation, owner, numbers):
        return TrackingController(no_force, (), *numbers)


if "none" not in kinds("tracking"):
    register(NoTracking)
