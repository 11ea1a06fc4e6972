"""How old what robots know of each other is."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

Array = NDArray[np.float64]


def ages(result: xr.Dataset, times: Array) -> Array:
    """How old what is known over each channel is (s), shape (channels, times).

    Between two samples the packet in use is the one at the later of them, for packets are taken after a sample.
    """
    known = result["traffic"].sel(count="sent_at").values
    later = np.minimum(np.searchsorted(result["time"].values, times), len(known) - 1)
    found: Array = (times[:, None] - known[later]).T
    return found
