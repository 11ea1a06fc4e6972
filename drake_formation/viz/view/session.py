"""A result in a browser, with sliders: the scenario is run anew with what they say, as often as it is asked for."""

import time
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from pydrake.geometry import Meshcat

from drake_formation.config.errors import ScenarioError
from drake_formation.scenario import Scenario
from drake_formation.simulation import PreparedRun, SimulationError
from drake_formation.simulation.result import labelled_result, series_of
from drake_formation.viz.view.flights import drawn_packets
from drake_formation.viz.view.knobs import KNOBS, Knob, changed
from drake_formation.viz.view.legend import share
from drake_formation.viz.view.recording import record

if TYPE_CHECKING:
    import xarray as xr

AGAIN, CLOSE = "run again", "close"
"""Buttons in the browser."""

POLL = 0.05
"""How long to wait before looking at the buttons once more (s)."""


class Session:
    """A result in Meshcat, and beside it sliders for those of :data:`KNOBS` that its scenario has.

    Args:
        meshcat: where.
        result: what is shown at first.
        follow: as for :func:`drake_formation.viz.view.record`.
        tell: called with what the user should know, such as why a run failed.

    Raises:
        ValueError, ScenarioError: it is not a result of this version.
    """

    def __init__(
        self, meshcat: Meshcat, result: "xr.Dataset", *, follow: bool = False, tell: Callable[[str], None] = print
    ) -> None:
        self._meshcat, self._follow, self._tell = meshcat, follow, tell
        self._scenario: Scenario = series_of(result).scenario
        self._playback = record(result, meshcat, follow=follow)
        self._start: dict[Knob, float] = {}
        for knob in KNOBS:
            if (place := knob.shown(self._scenario)) is not None:
                self._start[knob] = meshcat.AddSlider(knob.label, knob.low, knob.high, knob.step, place)
        meshcat.AddButton(AGAIN, "KeyR")
        meshcat.AddButton(CLOSE)
        self._runs = 0

    def serve(self) -> None:
        """Tell what is seen, and run again whenever that is asked for, until the session is closed."""
        self._describe()
        while not self._meshcat.GetButtonClicks(CLOSE):
            if (clicks := self._meshcat.GetButtonClicks(AGAIN)) > self._runs:
                self._runs = clicks
                self.run_again()
            time.sleep(POLL)

    def run_again(self) -> None:
        """Run the scenario with what the sliders say; a run that fails leaves the picture as it is."""
        places = {knob: self._meshcat.GetSliderValue(knob.label) for knob in self._start}
        try:
            scenario = changed(self._scenario, places, self._start)
            series = self._prepared.run(scenario)
        except (ScenarioError, SimulationError) as error:
            self._tell(str(error))
            return
        moved = [f"{k.path}={k.value(place):g}" for k, place in places.items() if place != self._start[k]]
        self._tell(f"Run with {', '.join(moved) or 'what the scenario says'}.")
        self._playback = record(labelled_result(series), self._meshcat, follow=self._follow)
        self._describe()

    def _describe(self) -> None:
        """Tell what the browser does not: what happened, and which packets are seen."""
        for event in self._playback.events:
            self._tell(str(event))
        if len(packets := drawn_packets(self._playback)):
            self._tell(f"Of packets {share(packets)}.")

    @cached_property
    def _prepared(self) -> PreparedRun:
        """The diagram made ready, once for all runs."""
        return PreparedRun.compiled(self._scenario)
