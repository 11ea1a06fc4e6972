"""What all channels have in common."""

from drake_formation.parts.part import Part


class Channel(Part):
    """A channel from a robot that speaks to one that hears."""

    @property
    def is_wire(self) -> bool:
        """Whether it is as the paper's: what is sent is received, at once and exactly."""
        return False

    @property
    def tells_traffic(self) -> bool:
        """Whether its block counts what becomes of packets, at an output port ``traffic``."""
        return False
