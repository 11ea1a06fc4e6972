"""Any scenario whose single fields are valid, for laws that hold for all of them."""

from hypothesis import strategies as st

from drake_formation.scenario.schema import Scenario

coordinates = st.floats(-1e6, 1e6)
points = st.tuples(coordinates, coordinates)
lengths = st.floats(0, 1e6, exclude_min=True)
positive = st.floats(0, exclude_min=True, allow_infinity=False)
non_negative = st.floats(0, allow_infinity=False)
numbers = st.floats(allow_nan=False, allow_infinity=False)
robots = st.integers(2, 6)
directions = st.floats(-720, 720)


def each(value):
    """One for all or one for each."""
    return value | st.lists(value, max_size=6)


def section(**fields):
    """A mapping of which any part may be left at its defaults."""
    return st.fixed_dictionaries({}, optional=fields)


shapes = st.one_of(
    st.fixed_dictionaries(
        {"shape": st.just("line"), "robots": robots, "side": lengths}, optional={"heading": directions}
    ),
    st.fixed_dictionaries(
        {"shape": st.just("polygon"), "robots": robots},
        optional={"side": lengths, "width": lengths, "heading": directions},
    ),
    st.fixed_dictionaries(
        {"shape": st.just("grid"), "rows": st.integers(1, 3), "columns": st.integers(1, 3), "side": lengths}
    ),
    st.fixed_dictionaries({"shape": st.just("slots"), "slots": st.lists(points, min_size=1, max_size=6)}),
)
starts = st.one_of(
    st.lists(points, min_size=1, max_size=6),
    st.fixed_dictionaries({"centre": points}),
    st.fixed_dictionaries(
        {
            "random": st.fixed_dictionaries(
                {"seed": st.integers(min_value=0), "about": points, "spread": lengths},
            )
        }
    ),
)
graphs = st.sampled_from(["complete", "cycle", "path", "star"]) | st.lists(
    st.tuples(st.integers(-1, 7), st.integers()), max_size=6
)
costs = numbers | st.lists(numbers, max_size=5) | st.lists(st.lists(numbers, max_size=5), max_size=5)
obstacles = st.lists(
    st.fixed_dictionaries({"position": points}, optional={"radius": st.floats(0, 1e6)}),
    max_size=3,
)
references = st.one_of(
    st.fixed_dictionaries({"kind": st.just("set_point")}),
    st.fixed_dictionaries({"kind": st.just("minimum_jerk")}, optional={"duration": positive}),
    st.fixed_dictionaries(
        {"kind": st.just("waypoints"), "points": st.lists(points, min_size=1, max_size=4)},
        optional={"duration": positive},
    ),
    st.fixed_dictionaries(
        {"kind": st.just("potential_field")},
        optional={
            "known": st.just("all") | st.lists(st.integers(0, 4), max_size=3),
            "clearance": st.floats(1e-3, 1e6),
            "reach": st.floats(1e-3, 1e6),
            "duration": positive,
        },
    ),
)

scenarios = st.fixed_dictionaries(
    {
        "name": st.from_regex(r"[A-Za-z0-9][A-Za-z0-9_.-]*", fullmatch=True),
        "formation": shapes,
        "robots": st.fixed_dictionaries({"start": starts}, optional={"mass": each(positive)}),
        "transport": st.fixed_dictionaries({"goal": points}, optional={"duration": positive, "reference": references}),
    },
    optional={
        "description": st.text(),
        "springs": section(
            graph=graphs,
            law=st.sampled_from(["hookean", "linear"]),
            stiffness=each(non_negative),
            damping=each(non_negative),
        ),
        "tracking": section(Q=costs, R=costs, feed_forward=st.booleans()),
        "consensus": section(graph=graphs, delta=non_negative, delta_v=non_negative),
        "avoidance": section(
            obstacles=obstacles, range=lengths, gain=non_negative, sensing=st.sampled_from(["in_range", "nearest"])
        ),
        "aggregation": section(duration=non_negative),
        "simulator": section(
            integration_scheme=st.text(),
            max_step_size=positive,
            accuracy=positive,
            use_error_control=st.booleans(),
            start_time=non_negative,
            target_realtime_rate=non_negative,
        ),
    },
).map(Scenario.model_validate)

st.register_type_strategy(Scenario, scenarios)
