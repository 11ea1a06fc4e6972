"""How many messages were delivered."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.traffic import traffic
from drake_formation.measuring.transport import Transport


@metric("messages_delivered", label="messages delivered", unit="1")
def messages_delivered(transport: Transport) -> float | None:
    """Packets delivered, over all channels."""
    packets = traffic(transport)
    return None if packets is None else float(packets.delivered.sum())
