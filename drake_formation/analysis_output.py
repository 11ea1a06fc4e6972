"""The folder a certificate leaves behind: written beside its place, and moved there when complete."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from drake_formation.analysis.certificate import Certificate
from drake_formation.analysis.errors import IllPosedError
from drake_formation.output import METRICS, RESULT, SCENARIO, OutputError, _moved_into_place, require_place
from drake_formation.scenario import to_yaml

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CERTIFICATE = "certificate.json"


def require_certificate_place(folder: Path) -> None:
    """Make sure that a certificate may be written to a folder.

    Raises:
        OutputError: as for a run; also where the folder holds a run, which would be lost.
    """
    require_place(folder)
    if not (folder / CERTIFICATE).exists() and any((folder / name).exists() for name in (RESULT, METRICS)):
        raise OutputError(f"{folder}: holds a run, which would be lost; give another folder")


def write_certificate(folder: Path, certificate: Certificate) -> list[str]:
    """Write a certificate, its scenario and its figures.

    Args:
        folder: where; an earlier certificate there is replaced as a whole.
        certificate: from :func:`drake_formation.analysis.certify`.

    Returns:
        Names of the figures, without those that have no answer to draw.

    Raises:
        OutputError: it cannot be written there.
    """
    require_certificate_place(folder)
    with _moved_into_place(folder) as partial:
        (partial / CERTIFICATE).write_text(certificate.to_json(), encoding="utf-8")
        (partial / SCENARIO).write_text(to_yaml(certificate.scenario), encoding="utf-8")
        (partial / "figures").mkdir()
        return [
            name for name, draw in FIGURES.items() if _drawn(partial / "figures" / f"{name}.png", draw, certificate)
        ]


def _drawn(file: Path, draw: Callable[[Certificate], "Figure"], certificate: Certificate) -> bool:
    try:
        figure = draw(certificate)
    except IllPosedError:
        return False
    figure.savefig(file, dpi=150)
    return True


def _mode_map(certificate: Certificate) -> "Figure":
    from drake_formation.viz.analysis_modes import mode_map

    return mode_map(certificate.modes, certificate.scenario.name)


def _root_locus(certificate: Certificate) -> "Figure":
    from drake_formation.viz.analysis_modes import root_locus

    return root_locus(certificate.formation)


def _error_against_effort(certificate: Certificate) -> "Figure":
    from drake_formation.viz.analysis_design import pareto_front

    return pareto_front(certificate.formation)


FIGURES: dict[str, Callable[[Certificate], "Figure"]] = {
    "mode_map": _mode_map,
    "root_locus": _root_locus,
    "error_against_effort": _error_against_effort,
}
"""Every figure of a certificate, by the name of its file."""
