"""Questions that have no number for an answer."""


class IllPosedError(ValueError):
    """A question without an answer, and why: the loop is unstable, a graph is not connected, a Riccati is singular."""
