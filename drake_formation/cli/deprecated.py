"""Commands by their former names, for one minor version."""

import sys

from drake_formation.cli.app import command
from drake_formation.cli.listing import What, show
from drake_formation.deprecation import LISTS, Deprecation


def _alias(what: What, deprecation: Deprecation) -> None:
    def listed() -> None:
        print(deprecation, file=sys.stderr)
        show(what, [])

    listed.__doc__ = str(deprecation)
    command(what.value, hidden=True)(listed)


for _deprecation in LISTS:
    _alias(What(_deprecation.what.split()[-1]), _deprecation)
