"""A scenario with sliders, in a notebook.

- ``panel`` makes one; it is what is public.
- ``widget``: the sliders and what they redraw.
- ``knobs``: which sliders there are.
- ``runs``: runs of variants, each of which needs no new diagram unless it is of another structure.
- ``picture``: a picture of which only what changes is drawn anew.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drake_formation.interactive.widget import Panel
    from drake_formation.scenario import Scenario

__all__ = ["panel"]


def panel(scenario: "Scenario") -> "Panel":
    """Sliders for the stiffness k, the gains δ and δ_v and the loss of packets, and beside them what becomes of a run.

    There is a slider for each of these that the scenario has, the same for all robots, edges or channels. When one is
    let go, the scenario is run again, by compiled code where it can be, and the picture is drawn anew: paths,
    consensus error over time, and in grey those of the scenario as it was given.

    Args:
        scenario: what to begin with; its channels must carry packets if there is to be a slider for their loss.

    Returns:
        A widget that a notebook shows; see :class:`drake_formation.interactive.widget.Panel`.

    Raises:
        MissingPackageError: the package ipywidgets is not installed.
        ScenarioError, SimulationError, PatienceError: the scenario is wrong, its run failed, or took too long.
    """
    from drake_formation.optional import required

    required("ipywidgets", "notebook")
    from drake_formation.interactive.widget import Panel

    return Panel(scenario)
