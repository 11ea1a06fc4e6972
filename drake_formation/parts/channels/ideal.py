"""The paper's channel: a wire."""

from drake_formation.formation.formation import Formation
from drake_formation.parts.channels.channel import Channel
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part


@part("channel", kind="ideal")
class IdealChannel(Channel):
    """What is sent is received, at once and exactly, as the paper assumes."""

    @property
    def is_wire(self) -> bool:
        """It is."""
        return True

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> None:  # noqa: ARG002
        """None: the listener's port is wired to the speaker's."""
        return
