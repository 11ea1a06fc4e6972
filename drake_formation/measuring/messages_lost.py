"""How many messages were lost."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.traffic import traffic
from drake_formation.measuring.transport import Transport


@metric("messages_lost", label="messages lost", unit="1")
def messages_lost(transport: Transport) -> float | None:
    """Packets lost, over all channels."""
    packets = traffic(transport)
    return None if packets is None else float(packets.lost.sum())
