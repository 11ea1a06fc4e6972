"""How much of the tables a reading explains."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import median

AGREES = 0.2
"""A cell agrees when it differs by at most this share of the published value; the paper prints two to three digits
of quantities that depend on inferred ones."""
CLOSE = 0.1
"""A cell is close when it differs by at most this share."""


def agrees(published: float, ours: float, share: float = AGREES) -> bool:
    """Whether a number is the published one to within a share of that."""
    return abs(ours - published) <= share * abs(published)


@dataclass(frozen=True)
class Score:
    """Numbers of cells, and how far the middle one is off.

    Attributes:
        cells: how many there are.
        agree: how many differ by at most ``AGREES``.
        close: how many differ by at most ``CLOSE``.
        off: median difference as a share of the published value.
    """

    cells: int
    agree: int
    close: int
    off: float

    def __str__(self) -> str:
        return f"{self.agree} of {self.cells}"


def score(pairs: Iterable[tuple[float, float]]) -> Score:
    """Compare published numbers with ours.

    Args:
        pairs: of each cell the published number and ours.
    """
    both: Sequence[tuple[float, float]] = list(pairs)
    return Score(
        cells=len(both),
        agree=sum(agrees(*pair) for pair in both),
        close=sum(agrees(*pair, CLOSE) for pair in both),
        off=median(abs(ours / published - 1) for published, ours in both) if both else 0.0,
    )
