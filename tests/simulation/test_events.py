"""What happened in a run is in its result, and survives being saved."""

import pytest
import xarray as xr

from drake_formation import load_scenario, simulate
from drake_formation.simulation import Event, events
from drake_formation.simulation.events import labelled_events
from drake_formation.viz import figures

QUICK = {"aggregation.duration": 2.0, "transport.duration": 1.0}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=QUICK), engine="blocks")


def test_the_hand_off_is_at_the_centre_of_the_robots_then(result):
    (event,) = events(result)
    assert (event.kind, event.time, event.who) == ("hand_off", 2.0, (1, 2))
    there = result["position"].sel(time=2.0).mean("robot").values
    assert event.place == pytest.approx(there, rel=1e-15)
    assert str(event).startswith("t = 2 s, (")
    assert event.sentence in str(event)


def test_a_run_that_begins_with_the_transport_has_no_hand_off():
    scenario = load_scenario("line", overrides=QUICK | {"aggregation.duration": 0.0})
    assert events(simulate(scenario, engine="blocks")) == ()


def test_events_are_saved_and_loaded_with_the_result(result, tmp_path):
    for name, kept in (("some", result), ("none", result.isel(event=[]))):
        kept.to_netcdf(tmp_path / f"{name}.nc")
        with xr.open_dataset(tmp_path / f"{name}.nc") as loaded:
            assert events(loaded) == events(kept)


def test_an_event_is_as_json_takes_it():
    event = Event("break", 1.5, (0.25, -1.0), (1, 2), "the spring breaks")
    assert event.to_dict() == {
        "kind": "break",
        "time": 1.5,
        "place": (0.25, -1.0),
        "who": (1, 2),
        "sentence": "the spring breaks",
    }


def test_a_result_that_knows_of_no_events_is_refused(result):
    with pytest.raises(ValueError, match="event_place"):
        events(result.drop_vars("event_place"))


def test_a_figure_marks_what_happened_where_and_when(result):
    happened = [Event("break", 2.5, (3.0, 1.0), (1, 2), "it breaks"), Event("break", 2.75, (3.5, 1.0), (1, 2), "again")]
    variables, coordinates = labelled_events(happened)
    broken = result.drop_dims("event").assign(variables).assign_coords(coordinates)
    axes = figures.paths(broken)
    (marks,) = [line for line in axes.lines if line.get_label() == "break, 2.5, 2.75 s"]
    assert marks.get_xydata().tolist() == [[3.0, 1.0], [3.5, 1.0]]
    over_time = figures.consensus_error(broken)
    assert {2.5, 2.75} <= {line.get_xdata()[0] for line in over_time.lines if len(line.get_xdata()) == 2}
