"""The files that come with the package, by name. Importing this is quick: the shell asks it while a user types."""

from pathlib import Path

_PACKAGE = Path(__file__).parent

FOLDER = next((path for path in (_PACKAGE / "diagrams", _PACKAGE.parent / "diagrams") if path.is_dir()), _PACKAGE)
"""A wheel carries them inside the package; in a checkout they stand beside it."""

KINDS = {"scenario": FOLDER, "sweep": FOLDER / "sweeps", "comparison": FOLDER / "comparisons"}
"""Folders by what is in them."""


def shipped(kind: str) -> dict[str, Path]:
    """Files of one kind, ``scenario``, ``sweep`` or ``comparison``, by name."""
    return {path.stem: path for path in sorted(KINDS[kind].glob("*.yaml"))}


def schema_file(kind: str) -> Path:
    """The JSON Schema of a kind of file, as of the parts that this package brings."""
    return FOLDER / "schema" / f"{kind}.schema.json"


def schema_line(kind: str) -> str:
    """The comment by which editors find the schema that came with the package on this machine."""
    return f"# yaml-language-server: $schema={schema_file(kind).as_uri()}\n"
