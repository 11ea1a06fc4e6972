"""The README's picture of the view, as a browser shows it: python tests/view_picture.py FILE."""

import sys
import tempfile
from pathlib import Path

from browsing import opened, page_address
from carrying import carried
from PIL import Image

from drake_formation import simulate
from drake_formation.viz.view import write_page

OBJECT = "{kind: lattice, stiffness: 60.0, shear_stiffness: 30.0}"
SCENE = {
    "robots": "{kind: {1: unicycle, 2: unicycle, default: omnidirectional}, "
    "start: [[0.4, 4.6], [0.6, 1.6], [3.3, 2.2], [3.2, 4.4]]}",
    "consensus": "{graph: [[1, 2], [2, 3], [3, 4], [4, 1], [1, 3]], delta: 20.0}",
    "avoidance": "{range: 1.3, gain: 60.0, obstacles: [{position: [6.5, 5.3], radius: 0.2}]}",
    "aggregation": "{duration: 10.0}",
    "transport": "{goal: [9.0, 3.2], duration: 20.0}",
}
TIME, COLOURS, SIZE = 11.5, 128, (1200, 700)


def main() -> None:
    result = simulate(carried(OBJECT, **SCENE))
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "view.html"
        write_page(result, page, follow=True)
        with opened(page_address(page), size=SIZE) as view:
            view.scrub(TIME)
            picture = Image.fromarray(view.picture().astype("uint8"))
    picture.quantize(COLOURS).save(sys.argv[1], optimize=True)


if __name__ == "__main__":
    main()
