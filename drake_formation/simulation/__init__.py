"""Running a scenario and labelling what comes out."""

from drake_formation.simulation.run import SimulationError, simulate, simulated_duration

__all__ = ["SimulationError", "simulate", "simulated_duration"]
