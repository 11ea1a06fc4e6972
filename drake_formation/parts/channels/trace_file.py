"""Measured delays and losses: one number a packet, from a file or as they are."""

import math
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, ValidationInfo

MOST = 100_000
"""A longer trace would make a diagram heavier than what it carries."""


def numbers_in(text: str) -> tuple[float, ...]:
    """The numbers of a trace: one a line; what follows ``#`` is a remark.

    Raises:
        ValueError: a line holds none, or not one; it is named.
    """
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        entry, hash_sign, _ = line.partition("#")
        if not entry.strip() and hash_sign:
            continue
        try:
            value = float(entry)
        except ValueError as error:
            hole = "nothing" if not entry.strip() else repr(entry.strip())
            raise ValueError(f"a trace has one number a line; line {number} has {hole}") from error
        if not math.isfinite(value) or value < 0:
            raise ValueError(f"a trace has finite numbers from 0 on; line {number} has {entry.strip()!r}")
        found.append(value)
    if not found:
        raise ValueError("a trace has at least one number; there is none")
    return tuple(found)


def _read(value: Any, info: ValidationInfo) -> Any:
    if not isinstance(value, str):
        return value
    folder = (info.context or {}).get("folder", ".")
    path = Path(folder, value).expanduser()
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise ValueError(f"the file cannot be read: {error}") from error
    try:
        return numbers_in(text)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


Trace = Annotated[
    tuple[Annotated[float, Field(ge=0)], ...],
    Field(strict=False, max_length=MOST),
    BeforeValidator(_read, json_schema_input_type=str | tuple[float, ...]),
]
"""Numbers, or the name of a file of them beside the scenario."""
