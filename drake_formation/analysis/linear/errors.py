"""Questions that have no number for an answer."""

import numpy as np

UNSOLVABLE = (np.linalg.LinAlgError, RuntimeError)
"""What NumPy, SciPy and Drake raise where numbers are too far apart in size for an equation to be solved."""


class IllPosedError(ValueError):
    """A question without an answer, and why: the loop is unstable, a graph is not connected, a Riccati is singular."""
