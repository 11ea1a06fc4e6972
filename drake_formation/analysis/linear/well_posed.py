"""What it takes for robots to agree at all (paper, Lemma 1)."""

import networkx as nx
import numpy as np

from drake_formation.analysis.linear.assumptions import require_displacements
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import LinearFormation


def require_agreement(formation: LinearFormation, purpose: str) -> None:
    """Refuse to choose consensus gains where robots cannot agree.

    Args:
        formation: whose graph is looked at.
        purpose: what there is nothing of then, such as "consensus gain to tune".

    Raises:
        IllPosedError: there is one robot only, the communication graph is not connected, or robots compare distances.
    """
    if formation.robots < 2:
        raise IllPosedError(f"one robot has no {purpose}; it takes two robots or more")
    require_displacements(formation.resolved, f"any {purpose}")
    parts = nx.number_connected_components(nx.from_numpy_array(np.abs(formation.laplacian)))
    if parts > 1:
        raise IllPosedError(
            f"the communication graph is in {parts} parts that never hear of each other, so there is no {purpose}; "
            "consensus.graph takes a connected one"
        )
