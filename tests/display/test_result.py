"""A result in a notebook: the paths of its robots and its metrics."""

import numpy as np
from short_runs import short
from shown import Shown

from drake_formation import load_result, metrics


def test_the_paths_go_where_the_robots_went():
    result = short()
    shown = Shown(result.formation._repr_html_())
    dotted, carried = (
        [given for tag, given in shown.elements if tag == "polyline" and given.get("stroke-dasharray") == dashes]
        for dashes in ("2 3", "none")
    )
    assert len(dotted) == len(carried) == 2
    ends = [np.array([p.split(",") for p in line["points"].split()], dtype=float)[[0, -1]] for line in carried]
    transport = result["position"].sel(time=result["phase"] == 1).values
    drawn, ran = ends[0][1] - ends[1][0], transport[-1, 0] - transport[0, 1]
    scale = np.hypot(*drawn) / np.hypot(*ran)
    assert np.allclose(drawn, scale * ran * [1, -1], atol=0.2)


def test_metrics_are_a_table_of_those_that_could_be_measured():
    figures = metrics(short())
    shown = Shown(figures._repr_html_())
    assert shown.count("tr") == sum(value is not None for value in figures.values())
    assert f"{figures.peak_force_n:.4g}" in shown.texts
    assert f"{figures.peak_force_n:.4g}" in Shown(short().formation._repr_html_()).texts


def test_a_title_is_text_and_a_run_without_transport_has_no_metrics():
    result = short().isel(time=slice(3)).assign_attrs(title="<script>alert(1)</script>")
    shown = Shown(result.formation._repr_html_())
    assert not shown.runs
    assert "<script>" in shown.text
    assert shown.count("td") == 0


def test_a_result_that_was_read_is_as_it_was(tmp_path):
    result = short()
    result.to_netcdf(tmp_path / "result.nc", engine="netcdf4")
    for source in (tmp_path, tmp_path / "result.nc"):
        read = load_result(source)
        assert read.formation.metrics.to_dict() == metrics(result).to_dict()
        assert read.formation.scenario == result.formation.scenario
        assert read.formation.events == result.formation.events
        assert read.formation._repr_html_() == result.formation._repr_html_()
