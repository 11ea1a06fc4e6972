from dataclasses import fields

import pytest

from drake_formation import Metrics
from drake_formation.sweep.quantities import LONG_NAMES, field_attributes, metric_attributes, metric_names


def test_every_metric_has_a_name_in_words():
    assert metric_names() == list(LONG_NAMES) == [field.name for field in fields(Metrics)]


@pytest.mark.parametrize(
    ("name", "units"),
    [("tracking_error_m", "m"), ("peak_force_n", "N"), ("settling_time_s", "s"), ("max_spring_strain", "1")],
)
def test_a_metrics_unit_is_the_end_of_its_name(name, units):
    assert metric_attributes(name)["units"] == units


@pytest.mark.parametrize(
    ("path", "units"),
    [
        ("springs.stiffness", "N/m"),
        ("springs.stiffness.3", "N/m"),
        ("consensus.delta_v", "N s/m"),
        ("avoidance.gain", "N m²"),
        ("avoidance.obstacles.0.position.1", "m"),
        ("robots.mass", "kg"),
        ("robots.start.random.spread", "m"),
        ("formation.side", "m"),
        ("formation.heading", "deg"),
        ("transport.reference.duration", "s"),
        ("springs.graph", None),
        ("tracking.Q.0.0", None),
        ("robots.start.random.seed", None),
        ("no.such.field", None),
    ],
)
def test_a_fields_unit_is_the_schemas(path, units):
    assert field_attributes(path).get("units") == units
