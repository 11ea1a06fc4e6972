import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from pydrake.systems.analysis import SimulatorConfig

from drake_formation.parts import ROLES
from drake_formation.parts.coordination.consensus import Consensus
from drake_formation.parts.robots.point_mass import PointMass
from drake_formation.parts.springs.hookean import SpringNumbers
from drake_formation.parts.tracking.lqr import Lqr
from drake_formation.scenario import schema
from drake_formation.scenario.schema import Line, Polygon, Robots, Scenario, Simulation


def sections():
    return [item for item in vars(schema).values() if isinstance(item, type) and issubclass(item, schema.Section)]


@pytest.mark.parametrize("section", sections(), ids=lambda section: section.__name__)
def test_sections_are_strict_frozen_and_finite(section):
    config = section.model_config
    assert (config["strict"], config["frozen"], config["extra"], config["allow_inf_nan"]) == (
        True,
        True,
        "forbid",
        False,
    )


@pytest.mark.parametrize(
    ("section", "field"),
    [
        (SpringNumbers, "stiffness"),
        (SpringNumbers, "damping"),
        (Consensus.Config, "delta"),
        (Consensus.Config, "delta_v"),
    ],
)
@given(value=st.floats(max_value=0, exclude_max=True) | st.just(math.nan) | st.just(math.inf))
def test_gains_are_finite_and_not_negative(section, field, value):
    with pytest.raises(ValidationError):
        section(**{field: value})


@pytest.mark.parametrize("value", ["1.0", True, None, [True], ["1"]])
def test_numbers_are_not_guessed(value):
    with pytest.raises(ValidationError):
        SpringNumbers(stiffness=value)


def test_whole_numbers_are_not_rounded():
    with pytest.raises(ValidationError):
        Line(shape="line", robots=2.0, side=1.0)


@pytest.mark.parametrize(
    "start", [[(0, 0), (1, 0)], {"random": {"seed": 1, "about": (0, 0), "spread": 1}}, {"centre": (0, 0)}]
)
def test_starts_of_every_kind(start):
    robots = Robots(start=start)
    assert Robots(start=robots.start) == robots


@pytest.mark.parametrize("cost", [1, (1, 1, 1, 1), ((1, 0), (0, 1))])
def test_costs_of_every_kind(cost):
    tracking = Lqr.Config(Q=cost)
    assert cost == tracking.Q


def test_no_point_lies_where_rounding_counts():
    with pytest.raises(ValidationError):
        Robots(start=[(2e6, 0)])


def test_defaults_are_the_published_values():
    assert (PointMass.Config().mass, SpringNumbers().stiffness, ROLES["spring"].default) == (40.0, 1.45, "hookean")
    gains = Consensus.Config()
    assert (Lqr.Config().Q, Lqr.Config().R, gains.delta, gains.delta_v) == (1.0, 1.0, 0.0, 0.0)


def test_simulator_fields_are_drakes():
    config = SimulatorConfig()
    for field in Simulation.model_fields:
        assert isinstance(getattr(Simulation(), field), type(getattr(config, field)))


def test_equality_ignores_whether_a_default_was_written_out():
    short = Polygon(shape="polygon", robots=3, side=1.0)
    assert Polygon(shape="polygon", robots=3, side=1.0, width=None, heading=None) == short


@given(st.from_type(Scenario))
def test_scenarios_survive_their_own_dump(scenario):
    assert Scenario.model_validate(scenario.model_dump()) == scenario
    assert Scenario.model_validate_json(scenario.model_dump_json()) == scenario
