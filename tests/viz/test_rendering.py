"""Graphviz's language drawn to files."""

import pytest

from drake_formation.viz.rendering import render, svg


def test_svg_shows_the_text():
    assert ">hello<" in svg('digraph { a [label="hello"] }')


def test_what_is_not_graphviz_is_refused():
    with pytest.raises(ValueError, match="cannot read"):
        svg("digraph {")


def test_dot_is_the_text_itself(tmp_path):
    render("digraph {}", tmp_path / "a.dot")
    assert (tmp_path / "a.dot").read_text() == "digraph {}"
