"""How old what robots know of each other is on average."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.traffic import traffic
from drake_formation.measuring.transport import Transport


@metric("mean_age_s", label="mean age of information", unit="s")
def mean_age(transport: Transport) -> float | None:
    """Mean age of information over time and channels (s)."""
    packets = traffic(transport)
    return None if packets is None else float(packets.mean_age.mean())
