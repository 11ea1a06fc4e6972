"""The diagram compiled: Drake's symbolic scalar traces the blocks, numba compiles what they compute."""

from drake_formation.lowering.compiled import CompiledDiagram, Status, Trajectory, lower
from drake_formation.lowering.errors import LoweringError

__all__ = ["CompiledDiagram", "LoweringError", "Status", "Trajectory", "lower"]
