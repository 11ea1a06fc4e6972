"""The diagram compiled: Drake's symbolic scalar traces the blocks, numba compiles what they compute."""

from drake_formation.lowering.compiled import CompiledDiagram, lower
from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.integration import Status, Trajectory

__all__ = ["CompiledDiagram", "LoweringError", "Status", "Trajectory", "lower"]
