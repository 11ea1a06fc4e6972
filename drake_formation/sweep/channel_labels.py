"""What the channel certificate says at every point of a sweep over delay and loss of packets."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from drake_formation.scenario import ScenarioError
from drake_formation.sweep.definition import Sweep

AXES = {"consensus.channel.delay", "consensus.channel.loss"}
"""Fields over which a sweep is a map of where the formation holds."""


def channel_labels(sweep: Sweep) -> NDArray[np.str_] | None:
    """Label of the channel certificate at every point, in the sweep's shape; None where its axes are others.

    What cannot be asked there is ``not certified``. A few seconds for a hundred points of four robots.
    """
    from drake_formation.analysis import ChannelVerdict, IllPosedError, channel_certificate, linearize
    from drake_formation.analysis.network.channel_verdict import UNKNOWN

    if [len(axis.columns) for axis in sweep.axes] != [1, 1] or _fields(sweep) != AXES:
        return None

    def label(index: int) -> str:
        try:
            verdict: ChannelVerdict | None = channel_certificate(linearize(sweep.scenario(index)))
        except (IllPosedError, ScenarioError):
            return UNKNOWN
        return UNKNOWN if verdict is None else verdict.label

    with threadpool_limits(limits=1, user_api="blas"):  # many small matrices
        return np.array([label(index) for index in range(len(sweep))]).reshape(sweep.shape)


def _fields(sweep: Sweep) -> set[str]:
    columns: list[Mapping[str, object]] = [axis.columns for axis in sweep.axes]
    return {path for column in columns for path in column}
