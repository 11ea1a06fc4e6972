"""One result, or several that are laid over each other, each with what it is called."""

from collections import Counter
from collections.abc import Mapping, Sequence

import xarray as xr

Results = xr.Dataset | Mapping[str, xr.Dataset] | Sequence[xr.Dataset]
"""From :func:`drake_formation.simulate`: one, several by their names, or several that are called what they are."""


def labelled(results: Results) -> dict[str, xr.Dataset]:
    """Results by name: their titles where they have no other, numbered where those are alike.

    Raises:
        ValueError: there is none.
    """
    if isinstance(results, xr.Dataset):
        return {str(results.attrs["title"]): results}
    named = _by_title(results) if isinstance(results, Sequence) else dict(results)
    if not named:
        raise ValueError("no result to draw")
    return named


def _by_title(results: Sequence[xr.Dataset]) -> dict[str, xr.Dataset]:
    titles = [str(result.attrs["title"]) for result in results]
    alike = Counter(titles)
    return {
        f"{title} {titles[: k + 1].count(title)}" if alike[title] > 1 else title: result
        for k, (title, result) in enumerate(zip(titles, results, strict=True))
    }


def transport(result: xr.Dataset) -> xr.Dataset:
    """The part of a result in which the object is carried; all of it where a run ended before."""
    carried = result["phase"].values == 1
    return result.isel(time=carried) if carried.sum() > 1 else result
