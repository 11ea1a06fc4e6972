import pytest

from drake_formation import load_scenario, metrics, simulate
from drake_formation.sweep.quantities import field_attributes, metric_attributes, metric_names


def test_every_metric_has_a_name_in_words():
    short = {"aggregation.duration": 0.2, "transport.duration": 0.2}
    assert metric_names() == list(metrics(simulate(load_scenario("line", overrides=short))))
    assert all(" " in metric_attributes(name)["long_name"] for name in metric_names())


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
        ("consensus.medium.bit_rate", "bit/s"),
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
