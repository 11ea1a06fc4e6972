"""``drake-formation view``: a scenario or a result in three dimensions, in the browser or as one page."""

import webbrowser
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.options import Overrides, path
from drake_formation.cli.simulating import simulate_with_progress
from drake_formation.terminal import FAILED_RUN, WRONG_INPUT, say, stop

if TYPE_CHECKING:
    import xarray as xr


@command(answers=False)
def view(
    source: Annotated[
        str,
        typer.Argument(
            metavar="SCENARIO|RESULT", help="A scenario file, the name of a shipped one, a run's folder or result.nc."
        ),
    ],
    overrides: Overrides = None,
    html: Annotated[
        Path | None,
        typer.Option(parser=path, metavar="FILE", help="Write one page that needs nothing else, and do not serve."),
    ] = None,
    follow: Annotated[bool, typer.Option("--follow", help="Keep the formation in the middle of the picture.")] = False,
    port: Annotated[
        int | None, typer.Option(min=1024, max=65535, help="Where to serve; default: the first free from 7000.")
    ] = None,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
) -> None:
    """See a scenario or a result move in the browser: play, pause, scrub, and run it again with other gains."""
    from drake_formation.places import OutputError, reason, reserved_file
    from drake_formation.simulation import SimulationError
    from drake_formation.viz.errors import PortError
    from drake_formation.viz.view.page import quiet_meshcat, write_page
    from drake_formation.viz.view.session import Session

    try:
        with reserved_file(html) if html else nullcontext() as partial:
            result = _result(source, overrides)
            if partial:
                write_page(result, partial, follow=follow)
    except SimulationError as error:
        stop(str(error), FAILED_RUN)
    except (ValueError, OutputError) as error:
        stop(str(error), WRONG_INPUT)
    except OSError as error:
        stop(f"{html}: {reason(error)}", WRONG_INPUT)
    if html:
        say(f"The view is in {html}.")
        return
    try:
        with quiet_meshcat(port) as meshcat:
            session = Session(meshcat, result, follow=follow, tell=say)
            say(f"The view is at {meshcat.web_url()}; its button 'close', or Ctrl-C, ends it.")
            if browser:
                webbrowser.open(meshcat.web_url())
            session.serve()
    except (PortError, ValueError) as error:
        stop(str(error), WRONG_INPUT)


def _result(source: str, overrides: list[str] | None) -> "xr.Dataset":
    """What to show: a result as it is, or what comes of a scenario.

    Raises:
        ValueError: it is a result that cannot be read, or values of it are to be replaced.
        ScenarioError, SimulationError: the scenario is wrong, or the run failed.
    """
    from drake_formation.results import RESULT, load_result
    from drake_formation.scenario import load_scenario

    if Path(source).suffix != Path(RESULT).suffix and not (Path(source) / RESULT).is_file():
        return simulate_with_progress(load_scenario(source, overrides=overrides))
    if overrides:
        raise ValueError(f"{source}: a result is shown as it is; --set goes with a scenario")
    return load_result(source)
