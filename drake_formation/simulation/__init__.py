"""Running a scenario and labelling what comes out."""

from drake_formation.simulation.phases import simulated_duration
from drake_formation.simulation.run import PreparedRun, SimulationError, simulate

__all__ = ["PreparedRun", "SimulationError", "simulate", "simulated_duration"]
