"""Pictures of runs and of diagrams.

- ``animate``: a result as a film, in a notebook or a file; see :mod:`drake_formation.viz.animation`.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from drake_formation.viz.animation import animate

__all__ = ["animate"]


def __getattr__(name: str) -> Any:
    """Matplotlib is imported where a film is first asked for."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from drake_formation.viz.animation import animate

    return animate
