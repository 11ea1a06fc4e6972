"""A result as one page: nothing outside it is loaded, so that it can be sent, kept and opened without a network."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from pydrake.geometry import Meshcat, MeshcatParams

from drake_formation.viz.errors import PortError
from drake_formation.viz.view.flights import drawn_packets
from drake_formation.viz.view.legend import legend
from drake_formation.viz.view.recording import record
from drake_formation.viz.view.timeline import timeline

if TYPE_CHECKING:
    import xarray as xr

DRAKES_TITLE = "<title>Drake MeshCat</title>"

CAPTION = """<style>
#caption {{ position: fixed; left: 1em; right: 1em; bottom: .5em; font: 13px sans-serif; color: #333;
  padding: .3em .6em; background: rgba(247, 247, 250, .85) }}
#caption b {{ padding: 0 .3em; border-radius: .2em; color: white; font-weight: normal }}
</style>
<div id="caption">{text}{timeline}</div>
"""


def write_page(result: "xr.Dataset", path: Path, *, follow: bool = False) -> None:
    """Write :func:`page` to a file.

    Raises:
        OSError: it cannot be written.
        ValueError, ScenarioError: as for :func:`page`.
    """
    path.write_text(page(result, follow=follow), encoding="utf-8")


def page(result: "xr.Dataset", *, follow: bool = False) -> str:
    """The recording of a result as HTML, with all that it needs; the browser plays it.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
        follow: as for :func:`drake_formation.viz.view.record`.

    Raises:
        ValueError, ScenarioError: it is not a result of this version.
    """
    with quiet_meshcat() as meshcat:
        playback = record(result, meshcat, follow=follow)
        text: str = meshcat.StaticHtml()
    title = escape(playback.title)
    caption = CAPTION.format(text=legend(playback, drawn_packets(playback)), timeline=timeline(playback))
    start, _, end = text.replace(DRAKES_TITLE, f"<title>{title}</title>").rpartition("</body>")
    return f"{start}{caption}</body>{end}"


@contextmanager
def quiet_meshcat(port: int | None = None) -> Iterator[Meshcat]:
    """A Meshcat for this machine alone, without Drake's line on where it listens.

    Raises:
        PortError: the port is taken, or there is none that is free.
    """
    log = logging.getLogger("drake")
    level = log.level
    log.setLevel(logging.WARNING)
    try:
        try:
            meshcat = Meshcat(MeshcatParams(host="localhost", port=port, show_stats_plot=False))
        except RuntimeError as error:
            where = "any port from 7000 to 7999" if port is None else f"port {port}"
            raise PortError(f"cannot serve at {where}: is it taken?") from error
        yield meshcat
    finally:
        log.setLevel(level)
