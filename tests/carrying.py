"""Small formations that carry an object which is a body of its own."""

from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate

TEXT = """\
name: carried
formation: {shape: polygon, robots: 4, side: 2.0}
robots: {start: {centre: [2.0, 3.0]}}
object: OBJECT
aggregation: {duration: 0.3}
transport: {goal: [4.0, 3.5], duration: 1.5}
"""


def carried(object_, **lines):
    """A scenario of a square of robots with an object as written in YAML; lines replace its sections."""
    text = TEXT.replace("OBJECT", object_)
    for name, line in lines.items():
        kept = [other for other in text.splitlines() if not other.startswith(f"{name}:")]
        text = "\n".join([*kept, f"{name}: {line}", ""])
    return validate(parse(text, "carried.yaml"))


UNLIKE = {"robots": "{start: [[0.9, 3.9], [0.9, 2.0], [3.1, 2.1], [3.1, 4.0]], mass: [30, 40, 50, 60]}"}
"""Robots that do not start in formation, and are not alike, so that the object turns and is strained."""
