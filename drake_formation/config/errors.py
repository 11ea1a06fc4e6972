"""What is wrong with a scenario, said so that the user can mend it without reading this code."""

import difflib
import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

Path = tuple[str | int, ...]
"""Where a value stands in a scenario: keys, and positions in lists from 0."""

_LONGEST = 60
_DEEPEST = 4
_PLAIN_TEXT = re.compile(r"[A-Za-z_][\w ./-]*")

MESSAGES = {
    "missing": "missing",
    "extra_forbidden": "unknown key",
    "finite_number": "not finite",
    "greater_than": "out of range",
    "greater_than_equal": "out of range",
    "less_than_equal": "out of range",
    "literal_error": "unknown name",
    "union_tag_invalid": "unknown name",
    "string_pattern_mismatch": "not a valid name",
    "too_long": "too many entries",
    "too_short": "too few entries",
}
"""What is wrong with a field, by pydantic's name for it."""


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong.

    Attributes:
        path: where in the scenario; empty for the scenario as a whole.
        message: what is wrong.
        value: the offending value as it would be written in YAML; empty if there is none.
        allowed: what may stand there instead.
        suggestion: the nearest valid name; empty if none is near.
        origin: where it was written: ``line.yaml:12``, ``--set springs.stiffness=-1`` …
    """

    path: Path
    message: str
    value: str = ""
    allowed: str = ""
    suggestion: str = ""
    origin: str = ""

    def __str__(self) -> str:
        """One line: ``ORIGIN: dotted.path: what is wrong (got VALUE); allowed: …; did you mean 'x'?``."""
        where = [part for part in (self.origin, dotted(self.path)) if part]
        got = f" (got {self.value})" if self.value else ""
        allowed = f"; allowed: {self.allowed}" if self.allowed else ""
        suggestion = f"; did you mean {self.suggestion!r}?" if self.suggestion else ""
        return " ".join(f"{': '.join([*where, self.message])}{got}{allowed}{suggestion}".splitlines())


class ScenarioError(ValueError):
    """A scenario with faults, all of them at once.

    Attributes:
        faults: what is wrong, in the order in which it was found.
    """

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = tuple(faults)
        super().__init__(self.faults)  # keeps the error picklable: workers of a sweep send it back

    def __str__(self) -> str:
        """One line a fault."""
        return "\n".join(map(str, self.faults))


def dotted(path: Path) -> str:
    """A path as users write it, such as ``avoidance.obstacles.0.position``."""
    return ".".join(map(str, path))


SYNONYMS = {
    **dict.fromkeys(("ring", "circle", "loop", "circular"), "cycle"),
    **dict.fromkeys(("all", "full", "fully_connected", "all_to_all", "mesh", "clique"), "complete"),
    **dict.fromkeys(("chain", "line", "string"), "path"),
    **dict.fromkeys(("hub", "wheel", "centralized"), "star"),
    **dict.fromkeys(("setpoint", "goal", "point"), "set_point"),
    **dict.fromkeys(("min_jerk", "jerk", "minimum-jerk", "straight"), "minimum_jerk"),
    **dict.fromkeys(("apf", "field", "plan", "planner"), "potential_field"),
    **dict.fromkeys(("spline", "way_points", "via_points"), "waypoints"),
    **dict.fromkeys(("hooke", "spring", "nonlinear"), "hookean"),
    **dict.fromkeys(("pointmass", "mass", "double_integrator"), "point_mass"),
    **dict.fromkeys(("omni", "holonomic", "mecanum", "omni_wheels", "swedish"), "omnidirectional"),
    **dict.fromkeys(("differential_drive", "diff_drive", "differential", "nonholonomic", "wheeled"), "unicycle"),
    **dict.fromkeys(("rigid_body", "solid", "body"), "rigid"),
    **dict.fromkeys(("plate", "deformable", "elastic", "soft", "mass_spring"), "lattice"),
    **dict.fromkeys(("wire", "perfect", "none"), "ideal"),
    **dict.fromkeys(("square", "rectangle", "triangle", "octagon", "hexagon", "circle_shape"), "polygon"),
}
"""What people of the field call what has another name here."""


def nearest(name: object, names: Iterable[str]) -> str:
    """The name meant: what the given one is a synonym of, else the one most like it, else an empty string."""
    if not isinstance(name, str):
        return ""
    known = list(names)
    if SYNONYMS.get(name.lower()) in known:
        return SYNONYMS[name.lower()]
    return next(iter(difflib.get_close_matches(name, known, n=1)), "")


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The end of a message about a name that nobody knows: the one that was meant, if there is one like it."""
    meant = nearest(name, known)
    return f"; did you mean {meant!r}?" if meant else ""


def shown(value: Any) -> str:
    """A value in YAML's flow style, shortened."""
    return shortened(_flow(value, _DEEPEST))


def shortened(text: str) -> str:
    """A text cut to what fits in a message."""
    return text if len(text) <= _LONGEST else text[: _LONGEST - 2] + " …"


def _flow(value: Any, depth: int) -> str:
    if not isinstance(value, dict | list | tuple):
        return _scalar(value)
    if depth == 0:
        return "…"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_flow(k, 1)}: {_flow(v, depth - 1)}" for k, v in value.items()) + "}"
    return "[" + ", ".join(_flow(item, depth - 1) for item in value) + "]"


def _scalar(value: Any) -> str:
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, int):
        # Python refuses to print integers of thousands of digits.
        return str(int(value)) if value.bit_length() < 200 else f"an integer of {value.bit_length()} bits"
    if isinstance(value, float):
        return re.sub("inf|nan", r".\g<0>", repr(float(value)))
    return repr(value)


def _text(value: str) -> str:
    plain = _PLAIN_TEXT.fullmatch(value) and value not in {"true", "false", "null"}
    return value if plain else json.dumps(value, ensure_ascii=not value.isprintable())
