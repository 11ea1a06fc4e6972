"""Running a scenario and labelling what comes out."""

from drake_formation.simulation.events import Event, events
from drake_formation.simulation.phases import simulated_duration
from drake_formation.simulation.run import PreparedRun, SimulationError, simulate

__all__ = ["Event", "PreparedRun", "SimulationError", "events", "simulate", "simulated_duration"]
