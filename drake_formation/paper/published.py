"""What the paper prints, and the provenance of what it does not."""

from functools import cache
from importlib.resources import files
from typing import Any

from ruamel.yaml import YAML


@cache
def published() -> dict[str, Any]:
    """The paper's tables, as ``published.yaml`` beside this file holds them."""
    text = files(__package__).joinpath("published.yaml").read_text(encoding="utf-8")
    numbers: dict[str, Any] = YAML(typ="safe").load(text)
    return numbers


PROVENANCE = (
    ("mass", "40 kg", "published"),
    ("stiffness k", "1.45 N/m rubber, 3e4 N/m steel", "published"),
    ("consensus gain δ", "0, 1e4, 2e4 N/m", "published"),
    ("velocity consensus gain δ_v", "0", "inferred: Δ is dimensionally inconsistent as printed; read as [δ I, 0]"),
    ("Q, R", "I4, I2", "published"),
    ("starts, N = 2 and 4", "published.yaml", "published"),
    ("starts, N = 8", "seeded random about (2.5, 3.5) m", "chosen: the paper says random"),
    ("side of line and square", "1 m", "published"),
    ("octagon", "1 m across flats", "inferred: at side 1 m the top edge would pass 0.35 m from an obstacle"),
    ("distance D", "22.5 m (N = 2), 25 m (N = 4, 8)", "inferred from the peak force at δ = 0"),
    ("sensing range ρ0", "1.3 m", "inferred"),
    ("avoidance gain η", "31.56 N m²", "inferred: fitted to e = 9.6 (N = 2, rubber, δ = 0), the only fit"),
    ("aggregation time T_agg", "60, 30, 40 s (N = 2, 4, 8)", "inferred from the floors of the consensus error"),
    ("transport duration", "60 s", "chosen"),
    ("spring and consensus graph", "complete", "published"),
    ("gains of the aggregation figures", "δ = 0, 1, 5 N/m", "chosen: the figures are lost"),
)
"""Every parameter of the study: what it is, its value, where it comes from."""
