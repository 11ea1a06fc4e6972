"""Running a scenario and labelling what comes out."""

from drake_formation.simulation.run import PreparedRun, SimulationError, simulate, simulated_duration

__all__ = ["PreparedRun", "SimulationError", "simulate", "simulated_duration"]
