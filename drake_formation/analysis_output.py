"""The folder a certificate leaves behind: written beside its place, and moved there when complete."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from threadpoolctl import threadpool_limits

from drake_formation.analysis.certificate import Certificate
from drake_formation.analysis.errors import UNSOLVABLE, IllPosedError
from drake_formation.output import SCENARIO, moved_into_place
from drake_formation.scenario import to_yaml

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CERTIFICATE = "certificate.json"

FEW_ROBOTS = 8
"""With more robots, error against channels is drawn only where the fewest channels are asked for."""


def write_certificate(folder: Path, certificate: Certificate) -> dict[str, str]:
    """Write a certificate, its scenario and its figures.

    Args:
        folder: where; an earlier certificate there is replaced as a whole.
        certificate: from :func:`drake_formation.analysis.certify`.

    Returns:
        Figures that were left out, by name, and why.

    Raises:
        OutputError: it cannot be written there.
    """
    # Many small matrices: threads of the linear algebra would wait for one another most of the time.
    with moved_into_place(folder, mark=CERTIFICATE) as partial, threadpool_limits(limits=1, user_api="blas"):
        (partial / CERTIFICATE).write_text(certificate.to_json(), encoding="utf-8")
        (partial / SCENARIO).write_text(to_yaml(certificate.scenario), encoding="utf-8")
        (partial / "figures").mkdir()
        left_out = {}
        for name, draw in FIGURES.items():
            try:
                draw(certificate).savefig(partial / "figures" / f"{name}.png", dpi=150)
            except (IllPosedError, *UNSOLVABLE) as reason:
                left_out[name] = str(reason)
        return left_out


def closing(folder: Path, left_out: dict[str, str]) -> str:
    """Where a certificate is, and which figures it is without."""
    lines = [f"No figure {figure}: {reason}." for figure, reason in left_out.items()]
    return "\n".join([*lines, f"Certificate in {folder}, figures in {folder / 'figures'}."])


def _mode_map(certificate: Certificate) -> "Figure":
    from drake_formation.viz.analysis_modes import mode_map

    return mode_map(certificate.modes, certificate.scenario.name)


def _root_locus(certificate: Certificate) -> "Figure":
    from drake_formation.viz.analysis_modes import root_locus

    return root_locus(certificate.formation)


def _error_against_effort(certificate: Certificate) -> "Figure":
    from drake_formation.viz.analysis_design import pareto_front

    return pareto_front(certificate.formation)


def _delay_margin(certificate: Certificate) -> "Figure":
    from drake_formation.viz.analysis_delay import delay_margin_against_delta

    if not certificate.formation.laplacian.any():
        raise IllPosedError("no robot talks to another, so no delay matters")
    return delay_margin_against_delta(certificate.formation)


def _error_against_channels(certificate: Certificate) -> "Figure":
    from drake_formation.analysis.topology import pareto_front
    from drake_formation.viz.analysis_topology import error_against_channels

    if certificate.formation.robots > FEW_ROBOTS and certificate.questions.consensus_error is None:
        raise IllPosedError("with so many robots it is drawn only where the fewest channels are asked for")
    return error_against_channels(pareto_front(certificate.formation))


FIGURES: dict[str, Callable[[Certificate], "Figure"]] = {
    "mode_map": _mode_map,
    "root_locus": _root_locus,
    "delay_margin": _delay_margin,
    "error_against_effort": _error_against_effort,
    "error_against_channels": _error_against_channels,
}
"""Every figure of a certificate, by the name of its file."""
