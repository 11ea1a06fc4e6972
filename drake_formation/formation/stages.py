"""Failures of robots as stages of a run: what is so from a time on, known before it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.links import Channels, Edges

Array = NDArray[np.float64]
Signals = dict[str, Array]
"""What changes, by the name of its port: a row for each stage, shape (stages, size)."""


@dataclass(frozen=True, eq=False)
class Stage:
    """What is so of every robot from a time on.

    Attributes:
        time: from when (s); minus infinity where it is so from the beginning.
        drive: 1 while it actuates, else 0; shape (N,).
        braking: 1/τ (1/s) while its brakes bring it to rest with the time constant τ, else 0; shape (N,).
        held: 1 while it holds the object, else 0; shape (N,).
        heeded: 1 while others listen to it and it to them, else 0; shape (N,).
        slots: where it should be relative to the formation centre (m), shape (N, 2).
    """

    time: float
    drive: Array
    braking: Array
    held: Array
    heeded: Array
    slots: Array


def signals(stages: Sequence[Stage], slots: Array, springs: Edges, channels: Channels) -> Signals:
    """What the blocks of a formation are told of its stages, as far as it ever changes.

    Of every robot i, from 1: ``failure_i`` [drive, free, braking], where free is 0 while it brakes and else 1;
    ``held_i``, for each of its springs 1 while both its robots hold; ``shift_i``, how far its slot has moved (m), as it
    is added to the motion [p; ṗ; p̈] of the formation centre; and of what it hears of robot j ``heard_i_j``
    [heeded, x, y], with how far its slot has moved beyond that of j (m). Of all: ``driven``, 1 while a robot actuates;
    ``held``, 1 while it holds the object; ``whole``, for each spring 1 while both its robots hold.

    Args:
        stages: in order of time, the first from the beginning.
        slots: as planned (m), shape (N, 2).
        springs: which robots the object couples.
        channels: which robots hear which.
    """
    drive, braking, held, heeded = (
        np.array([getattr(stage, name) for stage in stages]) for name in ("drive", "braking", "held", "heeded")
    )
    shift = np.array([stage.slots for stage in stages]) - slots
    first, second = springs.pairs.T
    whole = held[:, first] * held[:, second]
    found: Signals = {"driven": drive, "held": held, "whole": whole}
    for i in range(len(slots)):
        found[f"failure_{i + 1}"] = np.column_stack([drive[:, i], braking[:, i] == 0, braking[:, i]]).astype(float)
        found[f"held_{i + 1}"] = whole[:, springs.incident(i)]
        found[f"shift_{i + 1}"] = np.column_stack([shift[:, i], np.zeros((len(stages), 4))])
    for i, j in channels.pairs.tolist():
        beyond = shift[:, i] - shift[:, j]
        found[f"heard_{i + 1}_{j + 1}"] = np.column_stack([heeded[:, i] * heeded[:, j], beyond])
    return {name: rows for name, rows in found.items() if (rows != rows[0]).any() or _unusual(name, rows)}


def _unusual(name: str, rows: Array) -> bool:
    """Whether something is other than in a sound formation from the beginning on."""
    usual = {"shift": 0.0, "heard": [1.0, 0.0, 0.0], "failure": [1.0, 1.0, 0.0]}
    return bool((rows != usual.get(name.split("_", maxsplit=1)[0], 1.0)).any())
