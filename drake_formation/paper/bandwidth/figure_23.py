"""Fig. 23 of the paper in its two readings, and what the channels of each topology hold."""

import numpy as np

from drake_formation.analysis.linear.motion_subspaces import rotation
from drake_formation.formation import graphs
from drake_formation.formation.rigidity import rigidity
from drake_formation.markdown import markdown_table
from drake_formation.measuring import metrics
from drake_formation.paper.bandwidth.runs import figure_23, formation, transport
from drake_formation.paper.runs import topology
from drake_formation.paper.runs import transport as as_printed
from drake_formation.paper.store import Store
from drake_formation.scenario import Scenario, resolve

PRINTED, DISTANCES = "as printed", "as probably simulated: on distances"
DISPLACEMENTS, STEEL = "the same, on displacements", "the same, on distances, steel"
LAWS_AND_MATERIALS = {
    DISTANCES: ("hookean", "rubber"),
    DISPLACEMENTS: ("linear", "rubber"),
    STEEL: ("hookean", "steel"),
}
"""What is simulated beside the figure as printed, by reading."""


def bandwidth_runs() -> list[Scenario]:
    """The runs of the section."""
    return [run for runs in _figure_23().values() for run in runs.values()]


def _figure_23() -> dict[str, dict[str, Scenario]]:
    named = figure_23()
    others = {
        reading: {name: transport(graph, *law_and_material) for name, graph in named.items()}
        for reading, law_and_material in LAWS_AND_MATERIALS.items()
    }
    printed = {
        name: topology(name) if graph.edges else as_printed("quadrilateral", "rubber", 0.0)
        for name, graph in named.items()
    }
    return {PRINTED: printed} | others


def figure_23_errors(store: Store) -> dict[str, dict[str, float]]:
    """Largest consensus error (cm) by reading and topology."""
    return {
        reading: {name: 100 * metrics(store[run]).consensus_error_m for name, run in runs.items()}
        for reading, runs in _figure_23().items()
    }


def figure_23_table(errors: dict[str, dict[str, float]]) -> str:
    """Fig. 23 as a Markdown table, with what distances over the channels hold."""
    slots = resolve(formation(4)).slots
    rows = []
    for name, graph in figure_23().items():
        held = rigidity(slots, graphs.edges(graph))
        shape = "minimally rigid" if held.minimally_rigid else "rigid" if held.rigid else f"{held.mechanisms} free"
        rows.append([name, f"{held.rank} of {held.needed}", shape, *(f"{of[name]:.2f}" for of in errors.values())])
    return markdown_table(
        ["channels", "independent distances", "shape", *(f"{reading} (cm)" for reading in errors)], rows
    )


def rotation_share(store: Store) -> float:
    """Share of the consensus error that is a rotation of the whole formation, where it is largest with 10 channels."""
    ten = list(figure_23())[2]
    error = store[_figure_23()[DISTANCES][ten]]["consensus_error"].values
    largest = error[np.linalg.norm(error, axis=-1).max(axis=1).argmax()].ravel()
    return float((rotation(resolve(formation(4)).slots) @ largest) ** 2 / (largest @ largest))


def of_the_paper(errors: dict[str, dict[str, float]], turned: float) -> str:
    """What becomes of Fig. 23.

    Args:
        errors: by reading and topology (cm).
        turned: share of what is left on rigid channels that is a rotation.
    """
    local, twelve, ten, eight, path, star = figure_23()
    printed = [errors[PRINTED][name] for name in (twelve, ten, eight, path, star)]
    found, steel = errors[DISTANCES], errors[STEEL]

    def more(name: str) -> str:
        return f"{100 * (found[name] / found[twelve] - 1):.3g} %"

    return (
        "The paper finds 10 channels as good as 12, and 8 and 6 worse. As printed, every topology has "
        f"{min(printed):.2f} to {max(printed):.2f} cm, the residual at the hand-off, which says nothing about "
        f"channels. On distances, 10 channels differ from 12 by {more(ten)}, while 8 are worse by {more(eight)}, the "
        f"path of 6 by {more(path)} and the star by {more(star)}: ten are the five edges that make four robots "
        f"rigid. What is left, {found[ten]:.2f} cm, is a rotation of the whole formation "
        f"({100 * turned:.2f} % of its square), which no distance resists; on displacements it is "
        f"{errors[DISPLACEMENTS][ten]:.2f} cm. An object of steel is rigid itself and leaves nothing to hold: "
        f"{steel[local]:.2f} cm without any channel, {steel[path]:.2f} cm with the path."
    )
