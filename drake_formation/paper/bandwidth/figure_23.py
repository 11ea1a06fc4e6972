"""Fig. 23 of the paper in its two readings, and what the channels of each topology hold."""

from typing import Any

from drake_formation.formation import graphs
from drake_formation.formation.rigidity import rigidity
from drake_formation.markdown import markdown_table
from drake_formation.measuring import Metrics
from drake_formation.paper.bandwidth.runs import figure_23, formation
from drake_formation.paper.readings.two_readings import PRINTED, PROBABLE, Reading
from drake_formation.paper.runs import MATERIALS
from drake_formation.paper.store import Store
from drake_formation.scenario import Scenario, resolve, with_overrides

AS_PRINTED, DISTANCES = PRINTED.title, f"{PROBABLE.title}: on distances"
DISPLACEMENTS, STEEL = "the same, on displacements", "the same, on distances, steel"


def bandwidth_runs() -> list[Scenario]:
    """The runs of the section, by their figures."""
    return [run for runs in _figure_23().values() for run in runs.values()]


def _figure_23() -> dict[str, dict[str, Scenario]]:
    return {
        AS_PRINTED: _runs(PRINTED),
        DISTANCES: _runs(PROBABLE),
        DISPLACEMENTS: _runs(PROBABLE, {"consensus.law": "linear"}),
        STEEL: _runs(PROBABLE, {"springs.stiffness": MATERIALS["steel"]}),
    }


def _runs(reading: Reading, changes: dict[str, Any] | None = None) -> dict[str, Scenario]:
    return {
        name: with_overrides(
            reading.topology(name) if graph.edges else reading.transport("quadrilateral", "rubber", 0.0), changes or {}
        )
        for name, graph in figure_23().items()
    }


def figure_23_measured(store: Store) -> dict[str, dict[str, Metrics]]:
    """Figures of the runs by reading and topology."""
    return {
        reading: {name: store.measured(run) for name, run in runs.items()} for reading, runs in _figure_23().items()
    }


def figure_23_table(measured: dict[str, dict[str, Metrics]]) -> str:
    """Fig. 23 as a Markdown table, with what distances over the channels hold."""
    slots = resolve(formation(4)).slots
    rows = []
    for name, graph in figure_23().items():
        held = rigidity(slots, graphs.edges(graph))
        shape = "minimally rigid" if held.minimally_rigid else "rigid" if held.rigid else f"{held.mechanisms} free"
        rows.append(
            [name, f"{held.rank} of {held.needed}", shape, *(f"{_error(of[name]):.2f}" for of in measured.values())]
        )
    return markdown_table(
        ["channels", "independent distances", "shape", *(f"{reading} (cm)" for reading in measured)], rows
    )


def of_the_paper(measured: dict[str, dict[str, Metrics]]) -> str:
    """What becomes of Fig. 23.

    Args:
        measured: by reading and topology.
    """
    errors = {reading: {name: _error(its) for name, its in of.items()} for reading, of in measured.items()}
    local, twelve, ten, eight, path, star = figure_23()
    printed = [errors[AS_PRINTED][name] for name in (twelve, ten, eight, path, star)]
    found, steel = errors[DISTANCES], errors[STEEL]
    left = measured[DISTANCES][ten]

    def more(name: str) -> str:
        return f"{100 * (found[name] / found[twelve] - 1):.3g} %"

    return (
        "The paper finds 10 channels as good as 12, and 8 and 6 worse. As printed, every topology has "
        f"{min(printed):.2f} to {max(printed):.2f} cm, the residual at the hand-off, which says nothing about "
        f"channels. On distances, 10 channels differ from 12 by {more(ten)}, while 8 are worse by {more(eight)}, the "
        f"path of 6 by {more(path)} and the star by {more(star)}: ten are the five edges that make four robots "
        f"rigid. What is left, {found[ten]:.2f} cm, is a rotation of the whole formation, which no distance resists, "
        f"but for {100 * left.deformed_m:.2f} cm; on displacements it is {errors[DISPLACEMENTS][ten]:.2f} cm. An "
        f"object of steel is rigid itself and leaves nothing to hold: {steel[local]:.2f} cm without any channel, "
        f"{steel[path]:.2f} cm with the path."
    )


def _error(figures: Metrics) -> float:
    """Largest consensus error (cm)."""
    return float(100 * figures.consensus_error_m)
