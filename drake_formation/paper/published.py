"""What the paper prints."""

from functools import cache
from importlib.resources import files
from typing import Any

from ruamel.yaml import YAML


@cache
def published() -> dict[str, Any]:
    """The paper's tables, as ``published.yaml`` beside this file holds them."""
    text = files(__package__).joinpath("published.yaml").read_text(encoding="utf-8")
    numbers: dict[str, Any] = YAML(typ="safe").load(text)
    return numbers
