"""A line of time under a view on which events are marked: a click goes to a moment, and what happened last is told."""

from collections.abc import Iterator
from html import escape

from drake_formation.viz.palette import ALARM
from drake_formation.viz.playback import Playback

STYLE = """
#timeline { position: relative; height: 14px; margin: .4em 0 .2em; background: #ddd; cursor: pointer }
#timeline i { position: absolute; top: 0; width: 3px; margin-left: -1px; height: 100%; background: ALARM }
#timeline i[data-kind=hand_off] { background: #333 }
#now { position: absolute; top: -3px; width: 2px; margin-left: -1px; bottom: -3px; background: #0060c0 }
""".replace("ALARM", ALARM)

BODY = """<div id="timeline">{marks}<span id="now"></span></div><div id="happened">&nbsp;</div>"""

SCRIPT = """
(() => {
  const line = document.getElementById("timeline"), now = document.getElementById("now");
  const told = document.getElementById("happened"), marks = [...line.querySelectorAll("i")];
  const time = () => viewer.animator.actions.reduce((latest, action) => Math.max(latest, action.time), 0);
  line.onclick = (event) => {
    const box = line.getBoundingClientRect();
    const share = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
    viewer.animator.pause();
    viewer.animator.seek(share * viewer.animator.duration);
    viewer.animator.display_progress(share * viewer.animator.duration);
  };
  const show = () => {
    const moment = time(), begin = Number(line.dataset.begin);
    now.style.left = 100 * moment / (viewer.animator.duration || 1) + "%";
    const last = marks.filter((mark) => Number(mark.dataset.time) <= moment).pop();
    const text = (begin + moment).toFixed(2) + " s" + (last ? " · last: " + last.title : "");
    if (told.textContent !== text) told.textContent = text;
    requestAnimationFrame(show);
  };
  show();
})();
"""


def timeline(playback: Playback) -> str:
    """The line as HTML, with its script, which looks at Meshcat's ``viewer``."""
    begin, marks = playback.begin, "".join(_marks(playback))
    body = BODY.format(marks=marks).replace('id="timeline"', f'id="timeline" data-begin="{begin!r}"', 1)
    return f"{body}<style>{STYLE}</style><script>{SCRIPT}</script>"


def _marks(playback: Playback) -> Iterator[str]:
    length = max(playback.end - playback.begin, 1e-9)
    for event in playback.events:
        moment = event.time - playback.begin
        told = escape(f"{event.time:.4g} s, {event.sentence}", quote=True)
        place = f"left: {100 * moment / length:.3f}%"
        yield f'<i style="{place}" title="{told}" data-time="{moment:.6g}" data-kind="{escape(event.kind)}"></i>'
