"""The folder that a certificate leaves behind."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from threadpoolctl import threadpool_limits

from drake_formation.analysis.certificate import Certificate
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.cli.run_folder import SCENARIO
from drake_formation.places import PICTURES, Kind, Place, Written, written
from drake_formation.scenario import dump_scenario
from drake_formation.viz.style import Drawn, draw_each

CERTIFICATE_FILE = "certificate.json"
CERTIFICATE = Kind(CERTIFICATE_FILE, (SCENARIO, PICTURES, CERTIFICATE_FILE))

FEW_ROBOTS = 8
"""With more robots, error against channels is drawn only where the fewest channels are asked for."""


def write_certificate(place: Place, certificate: Certificate, file_format: str = "png") -> Written:
    """Write a certificate, its scenario and its figures.

    Args:
        place: where.
        certificate: from :func:`drake_formation.analysis.certify`.
        file_format: of the figures, png, pdf or svg.

    Raises:
        OutputError: it cannot be written anywhere.
    """

    def write(folder: Path) -> dict[str, str]:
        (folder / CERTIFICATE_FILE).write_text(certificate.to_json(), encoding="utf-8")
        dump_scenario(certificate.scenario, folder / SCENARIO)
        (folder / PICTURES).mkdir()
        drawn = {name: partial(draw, certificate) for name, draw in FIGURES.items()}
        # Many small matrices: threads of the linear algebra would wait for one another most of the time.
        with threadpool_limits(limits=1, user_api="blas"):
            return draw_each(drawn, folder / PICTURES, file_format)

    return written(place, write)


def _mode_map(certificate: Certificate) -> Drawn:
    from drake_formation.viz.analysis_modes import mode_map

    return mode_map(certificate.modes, certificate.scenario.name)


def _root_locus(certificate: Certificate) -> Drawn:
    from drake_formation.viz.analysis_modes import root_locus

    return root_locus(certificate.formation)


def _error_against_effort(certificate: Certificate) -> Drawn:
    from drake_formation.viz.analysis_design import pareto_front

    return pareto_front(certificate.formation)


def _delay_margin(certificate: Certificate) -> Drawn:
    from drake_formation.viz.analysis_delay import delay_margin_against_delta

    if not certificate.formation.laplacian.any():
        raise IllPosedError("no robot talks to another, so no delay matters")
    return delay_margin_against_delta(certificate.formation)


def _error_against_channels(certificate: Certificate) -> Drawn:
    from drake_formation.analysis.topology.cheapest_graph import pareto_front
    from drake_formation.viz.analysis_topology import error_against_channels

    if certificate.formation.robots > FEW_ROBOTS and certificate.questions.consensus_error is None:
        raise IllPosedError("with so many robots it is drawn only where the fewest channels are asked for")
    return error_against_channels(pareto_front(certificate.formation))


FIGURES: dict[str, Callable[[Certificate], Drawn]] = {
    "mode_map": _mode_map,
    "root_locus": _root_locus,
    "delay_margin": _delay_margin,
    "error_against_effort": _error_against_effort,
    "error_against_channels": _error_against_channels,
}
"""Every figure of a certificate, by the name of its file."""
