"""What is guaranteed before simulating: certificates computed from the linearized diagram."""

from drake_formation.analysis.linearization import NOT_COVERED, LinearFormation, linearize

__all__ = ["NOT_COVERED", "LinearFormation", "linearize"]
