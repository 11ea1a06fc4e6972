"""What is seen, and in which colours."""

from html import escape

import numpy as np

from drake_formation.viz.links import PRESSED, STRETCHED, largest_strain, moving_links
from drake_formation.viz.packets import OLD, Packets
from drake_formation.viz.playback import Playback
from drake_formation.viz.view.flights import FLYING, LOST
from drake_formation.viz.view.link_drawer import CHANNEL, SILENT
from drake_formation.viz.view.marks import ALARM, HAND, MOST, pinned


def legend(playback: Playback, packets: Packets) -> str:
    """A line of HTML under a view.

    Args:
        playback: what is seen.
        packets: those that are drawn.
    """
    links = moving_links(playback)
    told = [f"<strong>{escape(playback.title)}</strong>"]
    if any(link.rest_length is not None for link in links):
        most = f"{100 * largest_strain(playback, links):.2g} %"
        shorter, longer = _word("shorter", PRESSED), _word("longer", STRETCHED)
        told.append(f"springs {shorter} or {longer} than at rest, full colour at {most}")
    if any(link.rest_length is None for link in links):
        told.append(f"{_word('channels', CHANNEL[:3])} come to a point at the robot that hears")
    if any(link.mortal is not None for link in links):
        told.append(f"{_word('thin and grey', SILENT)} where {silence(playback)}")
    if len(packets):
        told.append(f"packets, {_word('used', FLYING[:3])} or {_word('lost', LOST[:3])}: {share(packets)}")
    if playback.formation.has_body:
        told.append(f"{_word('hands', HAND[:3])} that hold the object")
    if len(pinned(playback.events)):
        first = f", the first {MOST}" if len(pinned(playback.events)) == MOST else ""
        told.append(f"{_word('pins', ALARM[:3])} where something happened{first}")
    if playback.formation.stages:
        told.append(f"a {_word('cross', ALARM[:3])} over robots out of order")
    if playback.lost:
        told.append(f"shown until {playback.end:.4g} s, when robots were beyond all bounds")
    return " · ".join(told)


def silence(playback: Playback) -> str:
    """When a channel is taken for dead."""
    dropped = any(getattr(part.config, "timeout", None) for part in playback.formation.parts["channel"])
    left_out = any(name.startswith("heard_") for name in playback.formation.signals)
    told = [
        *([f"nothing younger than {OLD:g} s is known"] * bool(playback.traffic[2])),
        *(["the time-out is over"] * dropped),
        *(["the robot is not heeded"] * left_out),
    ]
    return " or ".join(told)


def share(packets: Packets) -> str:
    """How many of the packets sent are drawn, and how long those that arrived were under way."""
    flights = (packets.end - packets.start)[~packets.lost]
    long = f", {1e3 * float(np.median(flights)):.3g} ms under way as a rule" if len(flights) else ""
    return f"{len(packets)} of {packets.out_of} sent are shown{long}"


def _word(text: str, colour: object) -> str:
    red, green, blue = (round(255 * share) for share in colour)  # type: ignore[attr-defined]
    return f'<b style="background: rgb({red}, {green}, {blue})">{text}</b>'
