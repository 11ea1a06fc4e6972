"""How many messages were overtaken by a later one."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.traffic import traffic
from drake_formation.measuring.transport import Transport


@metric("messages_overtaken", label="messages overtaken by a later one", unit="1")
def messages_overtaken(transport: Transport) -> float | None:
    """Packets overtaken by a later one, over all channels."""
    packets = traffic(transport)
    return None if packets is None else float(packets.overtaken.sum())
