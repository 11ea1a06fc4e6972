"""How many messages were sent."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.traffic import traffic
from drake_formation.measuring.transport import Transport


@metric("messages_sent", label="messages sent", unit="1")
def messages_sent(transport: Transport) -> float | None:
    """Packets sent, over all channels."""
    packets = traffic(transport)
    return None if packets is None else float(packets.sent.sum())
