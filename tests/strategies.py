"""Random small scenarios, sound by construction, and states near their formations; shared by the tests."""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from hypothesis import strategies as st

from drake_formation.formation.formation import Array
from drake_formation.scenario import Scenario, resolve

SPACING = 0.5
"""No two slots of a random scenario are nearer to each other (m)."""

generators = st.integers(0, 2**32 - 1).map(np.random.default_rng)
"""Random numbers, the same for the same example."""

metres = st.floats(-5, 5, allow_subnormal=False)
speeds = st.floats(-2, 2, allow_subnormal=False)
gains = st.floats(0, 1e4, allow_subnormal=False)
up_to_three = st.integers(0, 3)
up_to_five = st.integers(1, 5)
either_law = st.sampled_from(["hookean", "linear"])


@dataclass(frozen=True, kw_only=True)
class Structure:
    """What a diagram is made of; the rest of a scenario are numbers."""

    robots: int
    springs: tuple[tuple[int, int], ...]
    channels: tuple[tuple[int, int], ...]
    law: str
    sensing: str
    obstacles: int


@st.composite
def graphs(draw, robots, connected=False):
    """Edges of a random graph, robots numbered from 1; a random tree is part of it where it must be connected."""
    pairs = list(combinations(range(1, robots + 1), 2))
    edges = set(draw(st.lists(st.sampled_from(pairs), unique=True))) if pairs else set()
    if connected:
        edges |= {(draw(st.integers(1, i - 1)), i) for i in range(2, robots + 1)}
    return tuple(sorted(edges))


@st.composite
def structures(draw, robots=up_to_five, law=either_law, obstacles=up_to_three):
    """A random structure over random graphs; the graph of channels is connected, as consensus needs."""
    count = draw(robots)
    return Structure(
        robots=count,
        springs=draw(graphs(count)),
        channels=draw(graphs(count, connected=True)),
        law=draw(law),
        sensing=draw(st.sampled_from(["in_range", "nearest"])),
        obstacles=draw(obstacles),
    )


@st.composite
def numbers(draw, structure, isotropic=False, homogeneous=False):
    """A scenario of a structure that begins with the transport; every robot and edge may have its own numbers."""
    rng = draw(generators)
    one_for_all = homogeneous or draw(st.booleans())
    slots = draw(shapes(structure.robots))

    def each(low, high, count):
        return float(rng.uniform(low, high)) if one_for_all else rng.uniform(low, high, count).tolist()

    # Obstacles stand clear of the starts but within range of some.
    obstacles = [
        {"position": position.tolist(), "radius": float(rng.uniform(0, 0.2))}
        for position in scattered(rng, structure.obstacles)
    ]
    mass = each(20, 80, structure.robots)
    return Scenario.model_validate(
        {
            "name": "random",
            "formation": slots,
            "robots": {"start": {"centre": rng.uniform(-0.1, 0.1, 2).tolist()}, "mass": mass},
            "springs": {
                "graph": structure.springs,
                "law": structure.law,
                "stiffness": each(0, 1000, len(structure.springs)),
                "damping": each(0, 50, len(structure.springs)),
            },
            "tracking": {"Q": cost(rng, 4, isotropic), "R": cost(rng, 2, isotropic)},
            "consensus": {
                "graph": structure.channels,
                "delta": float(rng.uniform(0, 1000)),
                "delta_v": float(rng.uniform(0, 50)),
            },
            "avoidance": {
                "obstacles": obstacles,
                "range": float(rng.uniform(2, 5)),
                "gain": float(rng.uniform(1, 50)),
                "sensing": structure.sensing,
            },
            "transport": {"goal": rng.uniform(20, 30, 2).tolist(), "duration": 1.0},
            "simulator": {"accuracy": 1e-9},
        }
    )


@st.composite
def shapes(draw, robots):
    """A formation of so many robots, of any shape that has as many."""
    side = draw(st.floats(SPACING, 2 * SPACING, allow_subnormal=False))
    heading = draw(st.floats(-180, 180, allow_subnormal=False))
    points = scattered(draw(generators), robots) / 3
    kinds = [
        {"shape": "line", "robots": robots, "side": side, "heading": heading},
        {"shape": "grid", "rows": 1, "columns": robots, "side": side},
        {"shape": "slots", "slots": points.tolist()},
    ]
    if robots > 1:
        kinds.append({"shape": "polygon", "robots": robots, "side": side, "heading": heading})
    return draw(st.sampled_from(kinds))


def scattered(rng, count):
    """Points on a ring about the origin, 3 to 6 m away and in sectors of their own, shape (count, 2)."""
    angles = 2 * np.pi * (np.arange(count) + rng.uniform(0.2, 0.8, count)) / max(count, 1)
    distances = rng.uniform(3, 6, count)
    return np.column_stack([distances * np.cos(angles), distances * np.sin(angles)])


def cost(rng, size, isotropic):
    """An LQR cost: a multiple of the identity, or any positive definite matrix."""
    if isotropic:
        return float(rng.uniform(0.5, 5))
    root = rng.uniform(-1, 1, (size, size))
    matrix = root @ root.T + 0.5 * np.eye(size)
    return ((matrix + matrix.T) / 2).tolist()


def scenarios(isotropic=False, homogeneous=False, **kinds):
    """Any small scenario that begins with the transport; see :func:`structures` and :func:`numbers`."""
    return structures(**kinds).flatmap(lambda structure: numbers(structure, isotropic, homogeneous))


def pairs_of_scenarios():
    """Two scenarios of one structure."""
    return structures().flatmap(lambda structure: st.tuples(numbers(structure), numbers(structure)))


def random_state(scenario: Scenario, rng: np.random.Generator) -> Array:
    """A state of all robots near their starts, no two at one place, shape (N, 4)."""
    starts = resolve(scenario).starts
    return np.hstack([starts + rng.uniform(-0.15, 0.15, starts.shape), rng.uniform(-2, 2, starts.shape)])
