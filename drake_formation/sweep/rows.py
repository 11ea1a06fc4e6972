"""The numbers of a run as bytes, and a checksum by which a row that is not as it was written is known."""

import json
import zlib
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_COMPRESSED = 128
"""More numbers than this are compressed."""


def layout_of(values: Mapping[str, Array]) -> str:
    """Names and shapes of values, in order: the same for most runs of a sweep."""
    return json.dumps([[name, list(np.shape(value))] for name, value in values.items()])


def shapes_in(layout: str) -> dict[str, tuple[int, ...]]:
    """Shapes by name, from a layout."""
    return {name: tuple(shape) for name, shape in json.loads(layout)}


def packed(values: Mapping[str, Array]) -> bytes:
    """All numbers one after another, bit by bit."""
    numbers = np.concatenate([np.zeros(0), *(np.ravel(value) for value in values.values())])
    data = numbers.astype("<f8").tobytes()
    return zlib.compress(data, 1) if len(numbers) > _COMPRESSED else data


def unpacked(layout: str, data: bytes) -> dict[str, Array]:
    """Values from their layout and numbers."""
    shapes = shapes_in(layout)
    counts = [int(np.prod(shape)) for shape in shapes.values()]
    numbers = np.frombuffer(zlib.decompress(data) if sum(counts) > _COMPRESSED else data, "<f8")
    pieces = np.split(numbers, np.cumsum(counts)[:-1]) if counts else []
    return {name: piece.reshape(shape) for (name, shape), piece in zip(shapes.items(), pieces, strict=True)}


def checksum(point: int, error: str | None, layout: str | None, data: bytes | None) -> int:
    """Of all that a row says."""
    return zlib.crc32(data or b"", zlib.crc32(repr((point, error, layout)).encode()))
