"""What happened in a run at one moment and place, such as the hand-off."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

HAND_OFF = "hand_off"
"""The kind of event that every run with an aggregation has."""


@dataclass(frozen=True)
class Event:
    """Something that happened.

    Attributes:
        kind: a word for it, such as ``hand_off``.
        time: when (s).
        place: where, in the world frame (m).
        who: the robots that it happened to, or the two that an edge joins; from 1.
        sentence: what happened, without time and place.
    """

    kind: str
    time: float
    place: tuple[float, float]
    who: tuple[int, ...]
    sentence: str

    def __str__(self) -> str:
        x, y = self.place
        return f"t = {self.time:.6g} s, ({x:.4g}, {y:.4g}) m: {self.sentence}"

    def to_dict(self) -> dict[str, Any]:
        """The event as JSON takes it."""
        return asdict(self)


def labelled_events(events: Sequence[Event]) -> "tuple[dict[str, xr.Variable], dict[str, Any]]":
    """Events as a variable of the labelled result, ``event_place``, and its coordinates.

    They have the dimension ``event``, along which ``event`` is the kind; ``event_time`` (s), ``event_who``, robots
    joined by dashes, and ``event_sentence`` go along.
    """
    import xarray as xr  # slow to import, and not needed to build a diagram

    places = np.array([event.place for event in events], dtype=float).reshape(-1, 2)
    about = {"units": "m", "long_name": "where an event happened"}
    texts = {
        "event": [event.kind for event in events],
        "event_who": ["-".join(map(str, event.who)) for event in events],
        "event_sentence": [event.sentence for event in events],
    }
    times = np.array([event.time for event in events], dtype=float)
    coordinates = {name: ("event", np.array(values, dtype=str)) for name, values in texts.items()}
    coordinates["event_time"] = ("event", times, {"units": "s", "long_name": "when an event happened"})  # type: ignore[assignment]
    return {"event_place": xr.Variable(("event", "axis"), places, about)}, coordinates


def events(result: "xr.Dataset") -> tuple[Event, ...]:
    """What happened in a run, in order of time.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.

    Raises:
        ValueError: it is a result of an earlier version, which knew of none.
    """
    if "event_place" not in result:
        raise ValueError("not a result of this version: it has no event_place")
    names = ("event", "event_time", "event_place", "event_who", "event_sentence")
    columns = [result[name].values.tolist() for name in names]
    return tuple(
        Event(str(kind), float(time), (x, y), tuple(map(int, str(who).split("-"))), str(sentence))
        for kind, time, (x, y), who, sentence in zip(*columns, strict=True)
    )
