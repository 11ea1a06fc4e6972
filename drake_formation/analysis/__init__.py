"""What is guaranteed before simulating: certificates computed from the linearized diagram.

``certify`` answers everything at once::

    from drake_formation import load_scenario
    from drake_formation.analysis import certify

    certificate = certify(load_scenario("line", overrides={"consensus.delta": 1e4}))
    certificate.stable, certificate.modes, certificate.sections["delay_relative"].delay_s

Each question is a function of its own, of the ``LinearFormation`` that ``linearize`` makes of a scenario.
"""

from drake_formation.analysis.certificate import Certificate, Questions, certify
from drake_formation.analysis.consensus_gain import SmallestDelta, smallest_delta
from drake_formation.analysis.errors import IllPosedError
from drake_formation.analysis.linearization import NOT_COVERED, LinearFormation, linearize
from drake_formation.analysis.local import LocalLoop, Margins, local_loops
from drake_formation.analysis.modes import Mode, Modes, modes
from drake_formation.analysis.remedies import Remedy, remedies
from drake_formation.analysis.rigidity import SpringLinearization, spring_linearization

__all__ = [
    "NOT_COVERED",
    "Certificate",
    "IllPosedError",
    "LinearFormation",
    "LocalLoop",
    "Margins",
    "Mode",
    "Modes",
    "Questions",
    "Remedy",
    "SmallestDelta",
    "SpringLinearization",
    "certify",
    "linearize",
    "local_loops",
    "modes",
    "remedies",
    "smallest_delta",
    "spring_linearization",
]
