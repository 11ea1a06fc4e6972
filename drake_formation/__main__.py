"""``python -m drake_formation``: the command line."""

from drake_formation.cli import main

main()
