"""Markdown tables read as tables whatever is in their cells."""

from hypothesis import given
from hypothesis import strategies as st
from markdown_it import MarkdownIt

from drake_formation.markdown import markdown_table

CELLS = st.text(st.sampled_from("ab|‖ 12"), min_size=1, max_size=8).map(str.strip).filter(bool)


@given(st.lists(st.lists(CELLS, min_size=3, max_size=3), min_size=1, max_size=4))
def test_a_table_has_its_rows_and_cells(rows):
    html = MarkdownIt("commonmark").enable("table").render(markdown_table(["a", "b", "c"], rows))
    assert html.count("<tr>") == len(rows) + 1
    assert html.count("<td>") == 3 * len(rows)
    for cell in (cell for row in rows for cell in row):
        assert f"<td>{cell}</td>" in html
