"""Largest strain of an object that is a body of its own."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport


@metric("max_object_strain", label="largest strain of the object", unit="1")
def max_object_strain(transport: Transport) -> float | None:
    """What the object tells at the integrator's steps, as its kind defines it; None where it is springs."""
    return float(transport["object_strain"].max()) if transport.formation.has_body else None
