"""Places for results: checked and reserved before anything is computed, taken when a result is complete.

Files are written to a hidden folder beside the place wanted, or inside it where that exists already, and moved to their
names at the end. So a result is there whole or not at all, and a place that cannot be used is known before the work.

- ``errors``: what the system says against a place, with its name.
- ``moves``: what a result consists of, and how its files get to their names.
- ``place``: a place that is reserved, filled and taken.
- ``reserve``: the checks before the work.
- ``written``: what there is to say afterwards.
"""

from drake_formation.places.errors import OutputError, reason
from drake_formation.places.moves import Kind
from drake_formation.places.place import Place
from drake_formation.places.reserve import make_folder, reserved, reserved_file
from drake_formation.places.written import PICTURES, Written, written

__all__ = [
    "PICTURES",
    "Kind",
    "OutputError",
    "Place",
    "Written",
    "make_folder",
    "reason",
    "reserved",
    "reserved_file",
    "written",
]
