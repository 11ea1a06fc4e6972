"""What is drawn over time: each quantity's name, symbol and unit, and how it comes from a result."""

from collections.abc import Callable
from dataclasses import dataclass

import xarray as xr

from drake_formation.vectors import length

CENTIMETRES = 100.0


@dataclass(frozen=True)
class Quantity:
    """What is drawn over time.

    Attributes:
        subject: its name.
        symbol: as the paper writes it.
        unit: in which it is drawn.
        of: from a result to the quantity over ``time`` and ``over``, in that unit.
        over: what has one each, ``robot`` or ``spring``.
        signed: whether it is below zero too.
    """

    subject: str
    symbol: str
    unit: str
    of: Callable[[xr.Dataset], xr.DataArray]
    over: str = "robot"
    signed: bool = False

    @property
    def label(self) -> str:
        """Of an axis."""
        return f"{self.subject}\n{self.symbol} ({self.unit})"

    @property
    def largest_label(self) -> str:
        """Of an axis that shows the largest one."""
        symbol = f"$|${self.symbol}$|$" if self.signed else self.symbol
        return f"largest {self.subject}\n{symbol} ({self.unit})"


def _elongation(result: xr.Dataset) -> xr.DataArray:
    """Of the springs while they hold the robots (cm)."""
    acting = (result["phase"] == 1) & (result["acting"] == 1 if "acting" in result else True)
    return CENTIMETRES * (result["spring_length"] - result["rest_length"]).where(acting)


def _force(subject: str, symbol: str, name: str) -> Quantity:
    return Quantity(subject, symbol, "N", lambda result: length(result[name]))


TRACKING_ERROR = Quantity(
    "tracking error", r"$\|\varepsilon_i\|$", "cm", lambda result: CENTIMETRES * length(result["deviation"])
)
CONSENSUS_ERROR = Quantity(
    "consensus error", r"$\|e_i\|$", "cm", lambda result: CENTIMETRES * length(result["consensus_error"])
)
ELONGATION = Quantity("spring elongation", "$d_{ij} - r_{ij}$", "cm", _elongation, "spring", signed=True)
FORCES = (
    _force("control force", r"$\|u_i\|$", "control_force"),
    _force("local LQR force", r"$\|u_{l,i}\|$", "tracking_force"),
    _force("consensus force", r"$\|u_{g,i}\|$", "consensus_force"),
    _force("avoidance force", r"$\|u_{\mathrm{apf},i}\|$", "avoidance_force"),
)
