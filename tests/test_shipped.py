"""Files that come with the package, and the schemas by which editors know them."""

import subprocess
import sys
from pathlib import Path
from urllib.parse import urlparse
from urllib.request import url2pathname

import pytest

from drake_formation.shipped import KINDS, folder_of, schema_file, schema_line, shipped

MARK = "# yaml-language-server: $schema="


def test_a_wheel_carries_them_inside_the_package_and_a_checkout_beside_it(tmp_path):
    package = tmp_path / "drake_formation"
    package.mkdir()
    (tmp_path / "diagrams").mkdir()
    assert folder_of(package) == tmp_path / "diagrams"
    (package / "diagrams").mkdir()
    assert folder_of(package) == package / "diagrams"


@pytest.mark.parametrize("kind", KINDS)
def test_every_file_names_a_schema_that_is_there(kind):
    assert shipped(kind)
    for file in shipped(kind).values():
        first = file.read_text(encoding="utf-8").splitlines()[0]
        assert first.startswith(MARK), file
        assert (file.parent / first.removeprefix(MARK)).resolve() == schema_file(kind).resolve()
        assert schema_file(kind).is_file()


def test_the_line_of_a_written_file_leads_there_from_anywhere():
    address = urlparse(schema_line("scenario").strip().removeprefix(MARK))
    assert address.scheme == "file"
    assert Path(url2pathname(address.path)) == schema_file("scenario")


@pytest.mark.parametrize("kind", KINDS)
def test_the_schemas_are_current(kind):
    """In a process of its own: a test may have registered parts in this one."""
    command = [sys.executable, "-m", "drake_formation", "schema", kind]
    printed = subprocess.run(command, capture_output=True, check=True, encoding="utf-8").stdout
    assert schema_file(kind).read_text(encoding="utf-8") == printed, "make diagrams writes it"
