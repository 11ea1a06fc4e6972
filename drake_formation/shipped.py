"""The files that come with the package, by name. Importing this is quick: the shell asks it while a user types."""

from pathlib import Path


def folder_of(package: Path) -> Path:
    """Where a package has them: a wheel carries them inside it; in a checkout they stand beside it."""
    return next((path for path in (package / "diagrams", package.parent / "diagrams") if path.is_dir()), package)


FOLDER = folder_of(Path(__file__).parent)

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
