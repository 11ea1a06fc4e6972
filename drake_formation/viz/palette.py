"""Colours that mean the same in every picture, film and view; those of robots are in :mod:`.figures.looks`."""

CHANNEL = "#009e73"
"""A channel over which something is heard."""

SILENT = "0.25"
"""One over which nothing is, as Matplotlib writes a grey."""

FLYING = "#00543d"
"""A packet on its way."""

ALARM = "#cc001a"
"""What was lost, has failed, broken or touched."""
