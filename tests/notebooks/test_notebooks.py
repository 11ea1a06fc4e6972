"""Every notebook runs from top to bottom, keeps no outputs in git, and takes nothing that is not public."""

import ast
import re
from importlib import import_module
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
each = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def read(path):
    return nbformat.read(path, as_version=4)


def sources(path, kind):
    return [cell.source for cell in read(path).cells if cell.cell_type == kind]


def program(path):
    """The code of a notebook without what only IPython understands."""
    return ast.parse("\n".join(re.sub(r"^%.*$", "", source, flags=re.MULTILINE) for source in sources(path, "code")))


def test_they_are_numbered_one_after_the_other():
    assert [int(path.stem[:2]) for path in NOTEBOOKS] == list(range(1, 11))


@pytest.mark.slow
@each
def test_it_runs(path, tmp_path):
    notebook = read(path)
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()


@each
def test_it_keeps_no_outputs_and_says_nothing_of_who_ran_it(path):
    notebook = read(path)
    nbformat.validate(notebook)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    assert notebook.metadata == {"kernelspec": kernel, "language_info": {"name": "python"}}
    for cell in notebook.cells:
        assert not cell.metadata
        assert not cell.get("outputs")
        assert cell.get("execution_count") is None


@each
def test_its_cells_are_named_for_good(path):
    names = [cell.id for cell in read(path).cells]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"[a-z][a-z0-9-]*", name) for name in names)


@each
def test_it_imports_what_is_public(path):
    imported = [node for node in ast.walk(program(path)) if isinstance(node, ast.ImportFrom | ast.Import)]
    own = [node for node in imported if isinstance(node, ast.ImportFrom) and "drake_formation" in str(node.module)]
    assert own
    assert all(
        "drake_formation" not in name.name for node in imported if isinstance(node, ast.Import) for name in node.names
    )
    for node in own:
        module = import_module(node.module)
        public = getattr(module, "__all__", None)
        assert module.__doc__
        for name in (alias.name for alias in node.names):
            assert not name.startswith("_")
            assert hasattr(module, name)
            assert name in public if public is not None else True, f"{node.module} does not export {name}"


@each
def test_it_reaches_into_nothing_private(path):
    private = [
        node.attr for node in ast.walk(program(path)) if isinstance(node, ast.Attribute) and node.attr.startswith("_")
    ]
    assert not private


@each
def test_it_tells_a_story_and_checks_it(path):
    first, *_ = sources(path, "markdown")
    assert first.startswith("# ")
    assert any(isinstance(node, ast.Assert) for node in ast.walk(program(path)))


@each
def test_its_links_lead_somewhere(path):
    for target in re.findall(r"\]\(([^)#]+)\)", "\n".join(sources(path, "markdown"))):
        assert target.startswith("https://") or (path.parent / target).exists(), target
