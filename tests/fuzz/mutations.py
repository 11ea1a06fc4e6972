"""Commands as users and their mistakes make them: scenarios, sweeps, ``--set`` and ``--out``, mutated by structure."""

import copy
import json
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

Path = tuple[str | int, ...]

SCENARIO: dict[str, Any] = {
    "name": "fuzzed",
    "formation": {"shape": "line", "robots": 2, "side": 1.0, "heading": 90.0},
    "robots": {"start": [[4.0, 5.0], [1.0, 2.0]], "mass": 40.0},
    "springs": {"graph": "complete", "law": "hookean", "stiffness": 1.45, "damping": 0.0},
    "tracking": {"Q": 1.0, "R": 1.0, "feed_forward": False},
    "consensus": {"graph": "complete", "delta": 10.0, "delta_v": 0.0},
    "avoidance": {"range": 1.3, "gain": 31.56, "obstacles": [{"position": [6.0, 5.05], "radius": 0.1}]},
    "aggregation": {"duration": 0.3},
    "transport": {"goal": [7.0, 3.5], "duration": 0.5, "reference": {"kind": "set_point"}},
    "simulator": {"integration_scheme": "runge_kutta5", "max_step_size": 0.1, "accuracy": 1e-4},
}

SWEEP: dict[str, Any] = {
    "name": "fuzzed",
    "scenario": "line",
    "set": {"transport.duration": 0.3, "aggregation.duration": 0.2, "simulator.accuracy": 1e-3},
    "axes": [{"path": "springs.stiffness", "values": [1.0, 2.0]}],
}

AXES: list[dict[str, Any]] = [
    {"path": "springs.stiffness", "logspace": [1.0, 10.0, 2]},
    {"path": ["consensus.delta", "consensus.delta_v"], "linspace": [0.0, 1.0, 2], "labels": ["a", "b"]},
    {"kind": "zip", "values": {"springs.stiffness": [1.0, 2.0], "consensus.delta": [0.0, 1.0]}},
    {"kind": "list", "points": [{"label": "a", "set": {"springs.stiffness": 1.0}}, {"label": "b", "set": {}}]},
    {"kind": "random", "seed": 1, "count": 2, "draw": {"robots.mass": {"normal": [40.0, 5.0]}}},
    {"kind": "random", "seed": 1, "count": 2, "draw": {"robots.mass": {"uniform": [40.0, 50.0]}}},
    {"kind": "random", "seed": 1, "count": 2, "draw": {"springs.stiffness": {"loguniform": [1.0, 5.0]}}},
    {"kind": "random", "seed": 1, "count": 1, "draw": {"formation.robots": {"integers": [2, 2]}}},
]

SHAPES: list[dict[str, Any]] = [
    {"shape": "line", "robots": 1, "side": 1.0},
    {"shape": "polygon", "robots": 3, "side": 1.0},
    {"shape": "grid", "rows": 2, "columns": 2, "side": 1.0},
    {"shape": "slots", "slots": [[0.0, 0.0], [1.0, 0.0]]},
]
REFERENCES: list[dict[str, Any]] = [
    {"kind": "minimum_jerk"},
    {"kind": "waypoints", "points": [[5.0, 3.0], [6.0, 3.0]]},
    {"kind": "potential_field", "clearance": 0.5, "reach": 1.0},
]

NUMBERS: list[Any] = [
    0, -1, 1, 0.0, -0.0, 1e-9, 1e-300, 5e-324, 1e300, -1e300, 1e9, 10**12, 10**400, 2**63, float("nan"), float("inf"),
    float("-inf"), 0.1, 3, 1000,
]  # fmt: skip
ODDITIES: list[Any] = [
    None, True, False, "", "yes", "1e4", "δ", "日本", "a" * 300, "a/b", "../x", "\x07", "[bold]", "$x$", "{", "'",
    [], {}, [[]], [None], {"": 1}, {"a": {"b": {"c": 1}}}, [[[[[[[1]]]]]]], [1, "2", None],
    [1.0, 2.0, 3.0], [[1.0, 2.0]], "all", "complete", "nearest", "line",
]  # fmt: skip
OUTS = [
    "", ".", "..", "/", "o", "o/p/q", "file", "file/x", "/dev/null", "/dev/null/x", "/dev/full", "/proc/x", "loop",
    "dangling", "full", "a" * 255, "a" * 256, "a" * 300, "a/" * 2000, "ä" * 128, "a\nb", "\udcff", "δ", "-", "~",
    "~root/x", "$HOME", "http://x", "a b", "a\tb", "[bold]", "o:x", "*", "o/.", "o/..", "./o/", "missing/../o", "\x7f",
    "x.nc", "CON",
]  # fmt: skip
OPTIONS = {
    "run": [["--engine", "blocks"], ["--engine", "nonsense"], ["--json"], ["-q"], ["-v"]],
    "validate": [["--json"], ["-q"], ["-q", "-v"]],
    "analyze": [
        ["--period", "0.1"], ["--damping-ratio", "1e-300"], ["--decay-rate", "nan"], ["--force-limit", "1e300"],
        ["--topology", "-1"], ["--damping-ratio", "x"],
    ],
    "graphviz": [["--depth", "2"], ["--depth", "0"], ["--depth", "99"]],
    "show": [["--json"], ["-q"]],
    "sweep": [["--executor", "serial"]],
}  # fmt: skip


@dataclass
class Case:
    """A command to try.

    Attributes:
        arguments: of the command.
        files: to be written beforehand, by name.
    """

    arguments: list[str]
    files: dict[str, str] = field(default_factory=dict)


def cases(seed: int) -> Iterator[Case]:
    """Cases without end, the same for the same seed."""
    number = 0
    while True:
        rng = random.Random(f"{seed}-{number}")
        yield rng.choices([_scenario_case, _override_case, _out_case, _sweep_case, _name_case], [5, 3, 2, 4, 1])[0](rng)
        number += 1


def _scenario_case(rng: random.Random) -> Case:
    command = rng.choices(["run", "validate", "analyze", "graphviz", "show"], [6, 3, 1, 1, 1])[0]
    text = _written(rng, mutated(rng, scenario(rng)))
    return Case([command, "s.yaml", *_options(rng, command), *_output(command, "o")], {"s.yaml": text})


def _override_case(rng: random.Random) -> Case:
    command = rng.choice(["run", "validate"])
    base = scenario(rng)
    overrides = [word for _ in range(rng.randint(1, 3)) for word in ("--set", _override(rng, base))]
    return Case([command, "s.yaml", *overrides, *_output(command, "o")], {"s.yaml": json.dumps(base)})


def _out_case(rng: random.Random) -> Case:
    command = rng.choices(["run", "sweep", "graphviz", "show", "reproduce", "analyze"], [6, 3, 2, 1, 2, 1])[0]
    out = rng.choice(OUTS)
    if command in ("graphviz", "show") and rng.random() < 0.7:
        out += rng.choice([".svg", ".dot"])
    files = {"s.yaml": json.dumps(SWEEP if command == "sweep" else SCENARIO)}
    source = ["--only", "table1"] if command == "reproduce" else ["s.yaml", *_options(rng, command)]
    return Case([command, *source, *_output(command, out)], files)


def _sweep_case(rng: random.Random) -> Case:
    sweep = copy.deepcopy(SWEEP)
    sweep["axes"] = [copy.deepcopy(axis) for axis in rng.sample(AXES, rng.choice([1, 1, 2]))]
    if rng.random() < 0.3:
        sweep["scenario"] = copy.deepcopy(SCENARIO)
    if rng.random() < 0.2:
        sweep["trajectories"] = {"variables": ["position"], "every": 0.1}
    text = _written(rng, mutated(rng, sweep))
    return Case(["sweep", "s.yaml", "--executor", "serial", "--out", "o"], {"s.yaml": text})


def _name_case(rng: random.Random) -> Case:
    """A new scenario, which is written where its name says and so must not lead out of the folder, or a list."""
    if rng.random() < 0.5:
        name = rng.choice([out for out in OUTS if not out.startswith("/")])
        return Case(["new", name, *rng.choice([[], ["--from", rng.choice(["line", "lime", "", "a/b"])]])])
    what = rng.choice(["scenarios", "sweeps", "comparisons", "parts", "metrics", "", "part", "δ"])
    return Case(["list", what, *rng.choice([[], ["mpc"], ["peak_force_n"], ["δ"], [""], ["--json"]])])


def scenario(rng: random.Random) -> dict[str, Any]:
    """A sound scenario that takes a moment to run."""
    made = copy.deepcopy(SCENARIO)
    if rng.random() < 0.3:
        made["formation"] = copy.deepcopy(rng.choice(SHAPES))
        made["robots"]["start"] = {"centre": [2.0, 3.0]}
    if rng.random() < 0.2:
        made["transport"]["reference"] = copy.deepcopy(rng.choice(REFERENCES))
    if rng.random() < 0.3:
        made["transport"]["duration"] = rng.choice([1e-12, 1e-9, 1e-6, 1e-3])
    return made


def mutated(rng: random.Random, data: dict[str, Any]) -> dict[str, Any]:
    """Data with up to three of its parts changed."""
    data = copy.deepcopy(data)
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        places = list(_places(data))
        if places:
            rng.choice(_CHANGES)(rng, data, rng.choice(places))
    return data


def _places(data: Any, path: Path = ()) -> Iterator[Path]:
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from _places(value, (*path, key))


def _around(data: Any, path: Path) -> Any:
    for key in path[:-1]:
        data = data[key]
    return data


def _odd(rng: random.Random) -> Any:
    return copy.deepcopy(rng.choice(NUMBERS if rng.random() < 0.6 else ODDITIES))


def _replace(rng: random.Random, data: Any, path: Path) -> None:
    _around(data, path)[path[-1]] = _odd(rng)


def _delete(rng: random.Random, data: Any, path: Path) -> None:
    del _around(data, path)[path[-1]]


def _misspell(rng: random.Random, data: Any, path: Path) -> None:
    around = _around(data, path)
    if isinstance(around, dict):
        key = str(path[-1])
        place = rng.randrange(len(key) + 1)
        around[rng.choice([key[:place] + "x" + key[place:], key.upper(), key + "δ", "", "a" * 300])] = around.pop(key)


def _repeat(rng: random.Random, data: Any, path: Path) -> None:
    around = _around(data, path)
    if isinstance(around, list):
        around.extend(copy.deepcopy([around[path[-1]]] * rng.choice([1, 2, 30])))
    else:
        around[path[-1]] = [copy.deepcopy(around[path[-1]])] * rng.choice([1, 2, 4])


def _scale(rng: random.Random, data: Any, path: Path) -> None:
    around = _around(data, path)
    value = around[path[-1]]
    if isinstance(value, int | float) and not isinstance(value, bool):
        scaled = value * rng.choice([-1, 1e-12, 1e-3, 3, 1e3, 1e12]) if "duration" not in path else 1e-9
        around[path[-1]] = int(scaled) if isinstance(value, int) else scaled
    else:
        around[path[-1]] = _odd(rng)


def _swap(rng: random.Random, data: Any, path: Path) -> None:
    other = rng.choice(list(_places(data)))
    _around(data, path)[path[-1]] = copy.deepcopy(_around(data, other)[other[-1]])


_CHANGES: list[Callable[[random.Random, Any, Path], None]] = [
    _replace,
    _replace,
    _scale,
    _delete,
    _misspell,
    _repeat,
    _swap,
]


def _override(rng: random.Random, base: dict[str, Any]) -> str:
    path = list(map(str, rng.choice(list(_places(base)))))
    if rng.random() < 0.3:
        path[rng.randrange(len(path))] = rng.choice(["", "x", "0", "-1", "99999999999", "δ", "a" * 300, "start"])
    values = [
        "",
        "[",
        "{",
        "&a 1",
        "*a",
        "!!python/object:os.system x",
        "- 1\n- 2",
        "|\n x",
        "%YAML 1.1",
        "<<: 1",
        "\x00"[:0],
    ]
    value = rng.choice(values) if rng.random() < 0.3 else _flow(_odd(rng))
    return ".".join(path) + rng.choice(["=", "=", "=", "==", " = ", ""]) + value


def _flow(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text.replace("-Infinity", "-.inf").replace("Infinity", ".inf").replace("NaN", ".nan")


def _written(rng: random.Random, data: dict[str, Any]) -> str:
    text = _flow(data)
    if rng.random() < 0.1:  # the text itself is damaged
        place = rng.randrange(len(text))
        text = (
            text[:place] + rng.choice(["", "}", ":", "\t", "\x00", "&a", "*a", "\n", "%", "\ud800"]) + text[place + 1 :]
        )
    return text


def _options(rng: random.Random, command: str) -> list[str]:
    if command == "sweep" or rng.random() < 0.15:
        return rng.choice(OPTIONS[command])
    return []


def _output(command: str, out: str) -> list[str]:
    if command == "validate":
        return []
    drawn = command in ("graphviz", "show")
    return ["-o", out if out != "o" else "o.svg"] if drawn else ["--out", out]
