"""How many messages were too late to be used."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.traffic import traffic
from drake_formation.measuring.transport import Transport


@metric("messages_late", label="messages too late to be used", unit="1")
def messages_late(transport: Transport) -> float | None:
    """Packets too late to be used, over all channels."""
    packets = traffic(transport)
    return None if packets is None else float(packets.late.sum())
