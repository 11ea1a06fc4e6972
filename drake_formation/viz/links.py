"""What is stretched between points that move: springs, the object's own or between robots, and channels."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.viz.packets import heard
from drake_formation.viz.playback import Playback

Array = NDArray[np.float64]

PRESSED, AT_REST, STRETCHED = np.array([[0.13, 0.40, 0.75], [0.72, 0.72, 0.72], [0.84, 0.19, 0.05]])
"""Colours of a spring's strain, which all eyes tell apart."""

LEAST_STRAIN = 0.01
"""The strain in full colour is no less (1), lest rounding look like a deformation."""


@dataclass(frozen=True)
class Link:
    """A line between two of the points.

    Attributes:
        name: unlike those of others.
        start: index of the point where it begins.
        end: index of the point where it ends.
        rest_length: of a spring, which is coloured by its strain (m); None for a channel.
        spring: which spring between robots it is, from 0, if it is one.
        mortal: which channel it is, from 0, if it is one that may fall silent.
    """

    name: str
    start: int
    end: int
    rest_length: float | None = None
    spring: int | None = None
    mortal: int | None = None


def moving_links(playback: Playback) -> list[Link]:
    """What is drawn between points that move: channels, and the springs of the object."""
    grid = grid_links(playback.formation) if playback.nodes else []
    return [*channel_links(playback.formation), *spring_links(playback.formation), *grid]


def channel_links(formation: Formation) -> list[Link]:
    """Who hears whom: a needle from the robot that speaks to a point at the one that hears."""
    links = []
    for k, (listener, speaker) in enumerate(formation.channels.pairs.tolist()):
        carries_packets = getattr(formation.parts["channel"][k], "tells_traffic", False)
        may_die = carries_packets or f"heard_{listener + 1}_{speaker + 1}" in formation.signals
        name = f"channels/{speaker + 1} to {listener + 1}"
        links.append(Link(name, speaker, listener, mortal=k if may_die else None))
    return links


def spring_links(formation: Formation) -> list[Link]:
    """The springs between robots, which are the points 0 … N-1."""
    pairs = formation.springs.pairs.tolist()
    return [
        Link(f"springs/{i + 1}-{j + 1}", i, j, rest_length=float(rest), spring=k)
        for k, ((i, j), rest) in enumerate(zip(pairs, formation.rest_lengths, strict=True))
    ]


def grid_links(formation: Formation) -> list[Link]:
    """The springs of a plate along its rows and columns; its nodes are the points after the robots."""
    config = formation.parts["object"][0].config
    slots, shape = formation.slots, (config.rows, config.columns)
    width, height = np.ptp(slots, axis=0) / np.maximum([config.columns - 1, config.rows - 1], 1)
    index = formation.robots + np.arange(config.rows * config.columns).reshape(shape)
    runs = [(index[:, :-1], index[:, 1:], width), (index[:-1], index[1:], height)]
    return [
        Link(f"object/{i - formation.robots + 1}-{j - formation.robots + 1}", i, j, float(rest))
        for starts, ends, rest in runs
        for i, j in zip(starts.ravel().tolist(), ends.ravel().tolist(), strict=True)
    ]


def present(playback: Playback, links: Sequence[Link], times: Array) -> NDArray[np.bool_]:
    """Whether each link is there: springs between robots only while they hold them, shape (m, links)."""
    return _of_those(playback.held(times), [link.spring for link in links])


def alive(playback: Playback, links: Sequence[Link], times: Array) -> NDArray[np.bool_]:
    """Whether each link is anything but a channel that fell silent, shape (m, links)."""
    if all(link.mortal is None for link in links):
        return np.ones((len(times), len(links)), dtype=bool)
    return _of_those(heard(playback, times), [link.mortal for link in links])


def _of_those(told: NDArray[np.bool_], which: Sequence[int | None]) -> NDArray[np.bool_]:
    """Columns by their number, true for None."""
    found = np.ones((len(told), len(which)), dtype=bool)
    for k, number in enumerate(which):
        if number is not None:
            found[:, k] = told[:, number]
    return found


def lengths(links: Sequence[Link], points: Array) -> Array:
    """Length d of every link (m), shape (…, links), between points of shape (…, points, 2)."""
    start, end = [link.start for link in links], [link.end for link in links]
    result: Array = np.linalg.norm(points[..., end, :] - points[..., start, :], axis=-1)
    return result


def strains(links: Sequence[Link], points: Array) -> Array:
    """d/r − 1 of every link (1), zero for channels; shapes as for :func:`lengths`."""
    rest = np.array([link.rest_length or np.inf for link in links])
    result: Array = np.where(np.isfinite(rest), lengths(links, points) / rest - 1.0, 0.0)
    return result


def strain_colour(share: float) -> tuple[float, float, float]:
    """Red, green and blue of a strain, as a share of the largest one shown: from −1, pressed, to 1, stretched."""
    far = STRETCHED if share > 0 else PRESSED
    red, green, blue = (AT_REST + min(abs(share), 1.0) * (far - AT_REST)).tolist()
    return red, green, blue


def largest_strain(playback: Playback, links: list[Link]) -> float:
    """The largest strain of a link while it carries the object (1), or the least that is told from rounding."""
    times = np.linspace(max(playback.begin, min(playback.formation.hand_off, playback.end)), playback.end, 2000)
    shown = np.where(present(playback, links, times), strains(links, playback.points(times)), 0.0)
    return max(LEAST_STRAIN, float(np.abs(shown).max(initial=0.0)))
