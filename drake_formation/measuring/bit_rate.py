"""How much is sent a second."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.traffic import traffic
from drake_formation.measuring.transport import Transport


@metric("bit_rate_bps", label="bits sent a second", unit="bit/s")
def bit_rate(transport: Transport) -> float | None:
    """Bits sent over all channels, by the duration of the transport (bit/s)."""
    packets = traffic(transport)
    return None if packets is None else float(packets.bits.sum() / packets.duration)
