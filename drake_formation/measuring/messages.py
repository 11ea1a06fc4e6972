"""Messages over all channels: what became of them, and how much is sent."""

from collections.abc import Callable

from drake_formation.measuring.metric import Metric, metric
from drake_formation.measuring.traffic import Traffic
from drake_formation.measuring.transport import Transport


def of_packets(name: str, label: str, unit: str, law: Callable[[Traffic], float]) -> Metric:
    """A metric of the packets of a run; None where no channel carries any."""

    @metric(name, label=label, unit=unit)
    def measure(transport: Transport) -> float | None:
        return None if transport.packets is None else float(law(transport.packets))

    return measure


sent = of_packets("messages_sent", "messages sent", "1", lambda packets: packets.sent.sum())
delivered = of_packets("messages_delivered", "messages delivered", "1", lambda packets: packets.delivered.sum())
lost = of_packets("messages_lost", "messages lost", "1", lambda packets: packets.lost.sum())
late = of_packets("messages_late", "messages too late to be used", "1", lambda packets: packets.late.sum())
overtaken = of_packets("messages_overtaken", "messages overtaken", "1", lambda packets: packets.overtaken.sum())
bit_rate = of_packets(
    "bit_rate_bps", "bits sent a second", "bit/s", lambda packets: packets.bits.sum() / packets.duration
)
