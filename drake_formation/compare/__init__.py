"""One scenario under several laws: the same starts, seeds and obstacles, and a table as a paper would have it.

- ``schema``: what a comparison file may say.
- ``comparison``: the runs that it means.
- ``run``: running them.
- ``table``: what came out, as Markdown, CSV and LaTeX.
- ``figures``: the laws laid over each other.
"""

from drake_formation.compare.comparison import Comparison, load_comparison, shipped_comparisons
from drake_formation.compare.run import Outcome, run_comparison
from drake_formation.compare.table import rows

__all__ = ["Comparison", "Outcome", "load_comparison", "rows", "run_comparison", "shipped_comparisons"]
