"""Sliders for a scenario's numbers, and what becomes of its run, as a widget."""

import math
import time
from typing import TYPE_CHECKING, Any

import ipywidgets as widgets

from drake_formation.config.errors import ScenarioError
from drake_formation.display.result import metrics_html
from drake_formation.interactive.knobs import ALL
from drake_formation.interactive.picture import Picture
from drake_formation.interactive.runs import PatienceError, Runs
from drake_formation.measuring import measure
from drake_formation.scenario import Scenario
from drake_formation.simulation import SimulationError
from drake_formation.simulation.result import labelled_result
from drake_formation.viz.view.knobs import Knob, changed

if TYPE_CHECKING:
    import xarray as xr


class Panel(widgets.VBox):  # type: ignore[misc]
    """Sliders, a picture, the metrics and a line that says how long it took.

    :func:`drake_formation.interactive.panel` makes one. A run that fails or takes longer than 5 s leaves the picture as
    it was, and the line says why.

    Args:
        scenario: what to begin with.

    Attributes:
        sliders: by the path of the number in a scenario, such as ``consensus.delta``.
        scenario: what is shown: the one given, with what the sliders say.
        redrawn_s: how long the last run and its picture took (s).

    Raises:
        ScenarioError, SimulationError, PatienceError: the scenario is wrong, its run failed, or took too long.
    """

    def __init__(self, scenario: Scenario) -> None:
        self._given = self.scenario = scenario
        self._runs = Runs()
        self._series = self._runs.run(scenario)
        self._drawing = Picture(self._series)
        self._knobs = {knob: place for knob in ALL if (place := knob.shown(scenario)) is not None}
        self.sliders = {knob.path: _slider(knob, place) for knob, place in self._knobs.items()}
        self._picture, self._metrics, self._line = widgets.Image(format="png"), widgets.HTML(), widgets.Label()
        super().__init__([*self.sliders.values(), self._picture, self._metrics, self._line])
        self.redrawn_s = 0.0
        self._redraw()
        for slider in self.sliders.values():
            slider.observe(self._moved, "value")

    @property
    def result(self) -> "xr.Dataset":
        """What is shown, as :func:`drake_formation.simulate` gives it."""
        return labelled_result(self._series)

    @property
    def picture(self) -> bytes:
        """The picture as PNG."""
        return bytes(self._picture.value)

    @property
    def line(self) -> str:
        """The line below: how long it took, or why a run failed."""
        text: str = self._line.value
        return text

    def _moved(self, _: Any) -> None:
        """Run the scenario with what the sliders say."""
        begin = time.perf_counter()
        places = {knob: _place(knob, self.sliders[knob.path].value) for knob in self._knobs}
        try:
            scenario = changed(self._given, places, self._knobs)
            self._series = self._runs.run(scenario)
        except (ScenarioError, SimulationError, PatienceError) as error:
            self._line.value = str(error)
            return
        self.scenario = scenario
        self._redraw()
        self.redrawn_s = time.perf_counter() - begin
        self._line.value = f"run and drawn in {self.redrawn_s:.2f} s"

    def _redraw(self) -> None:
        self._picture.value = self._drawing.drawn(self._series)
        self._metrics.value = metrics_html(measure(self._series))


def _slider(knob: Knob, place: float) -> widgets.Widget:
    """A slider where it stands for the scenario; it tells of itself when it is let go."""
    look = {"continuous_update": False, "style": {"description_width": "10em"}, "layout": {"width": "40em"}}
    if knob.logarithmic:
        label = knob.label.removeprefix("log10 of ")
        value, ends = 10.0**place, {"min": knob.low, "max": knob.high, "step": knob.step}
        return widgets.FloatLogSlider(value, description=label, readout_format=".4g", **ends, **look)
    return widgets.FloatSlider(place, min=knob.low, max=knob.high, step=knob.step, description=knob.label, **look)


def _place(knob: Knob, value: float) -> float:
    return math.log10(value) if knob.logarithmic else value
