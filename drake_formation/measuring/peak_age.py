"""How old what a robot knows of another is at worst."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.traffic import traffic
from drake_formation.measuring.transport import Transport


@metric("peak_age_s", label="peak age of information", unit="s")
def peak_age(transport: Transport) -> float | None:
    """Largest age of information of any channel at any time (s)."""
    packets = traffic(transport)
    return None if packets is None else float(packets.peak_age.max())
