"""Pictures look as they did when somebody looked at them.

``PYTHONPATH=tests python tests/viz/figures/test_images.py`` makes those that are kept anew.
"""

from pathlib import Path

import numpy as np
import pytest
from made_up_run import made_up_run
from matplotlib.testing.compare import compare_images

from drake_formation.viz.figures import consensus_error, control_forces, overview
from drake_formation.viz.style import figure_of, own_style

BASELINES = Path(__file__).parent / "images"
TOLERANCE = 4.0
"""Root mean square of the differences of all pixels' shades, of 255: less than half of what a changed line makes."""


PICTURES = {
    "stiff-forces": lambda: control_forces(made_up_run(), width="column"),
    "errors": lambda: consensus_error({"soft": made_up_run(2, stiff=False), "stiff": made_up_run(2)}, width="column"),
    "overview": lambda: overview(made_up_run(3, stiff=False), width="column"),
}


def draw(make, path):
    """Draw a picture of few pixels."""
    with own_style():
        figure_of(make()).savefig(path, dpi=72)


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_as_it_was(name, tmp_path):
    draw(PICTURES[name], tmp_path / f"{name}.png")
    assert compare_images(BASELINES / f"{name}.png", tmp_path / f"{name}.png", TOLERANCE) is None


def test_a_real_change_is_seen(tmp_path):
    """A line of one robot that is somewhere else, and forces that begin with the aggregation again."""
    moved = made_up_run(2).assign(consensus_error=3.0 * made_up_run(2)["consensus_error"])
    changed = {
        "errors": lambda: consensus_error({"soft": made_up_run(2, stiff=False), "stiff": moved}, width="column"),
        "stiff-forces": lambda: control_forces(made_up_run(), whole=True, width="column"),
    }
    for name, make in changed.items():
        draw(make, tmp_path / f"{name}.png")
        assert compare_images(BASELINES / f"{name}.png", tmp_path / f"{name}.png", TOLERANCE) is not None


def test_the_forces_of_a_stiff_run_show_its_transport():
    """Forces of 180 kN before the hand-off neither set the scale nor hide what comes after."""
    run = made_up_run()
    assert float(run["control_force"].max()) > 1.7e5
    panel = control_forces(run)[0]
    bottom, top = panel.get_ylim()
    assert top < 1e3
    assert panel.get_yscale() == "log"
    transport = run["control_force"].values[run["phase"].values == 1][..., 0]
    inside = (transport > bottom) & (transport < top)
    assert inside.mean() > 0.9
    assert np.log10(top / bottom) < 5


if __name__ == "__main__":
    for name, make in PICTURES.items():
        draw(make, BASELINES / f"{name}.png")
