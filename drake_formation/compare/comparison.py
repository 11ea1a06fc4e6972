"""A comparison: one scenario under several laws, in several cases, from several starts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from drake_formation.compare.schema import SECTIONS, ComparisonFile, Variant
from drake_formation.config.errors import Fault, ScenarioError
from drake_formation.scenario import Scenario
from drake_formation.scenario.load import find_file
from drake_formation.scenario.source import Document, parse, read_text
from drake_formation.scenario.validate import validate
from drake_formation.shipped import shipped
from drake_formation.sweep.base import base_document, mapped_document, with_values
from drake_formation.sweep.faults import parsed
from drake_formation.sweep.limits import value_faults

MOST_RUNS = 10_000
"""Of a comparison; a table of more is a sweep."""

SEED = "robots.start.random.seed"


@dataclass(frozen=True)
class Run:
    """One run of a comparison.

    Attributes:
        law: name of the law.
        case: name of the case.
        seed: of the random starts; None where the scenario's own are used.
        scenario: what runs.
    """

    law: str
    case: str
    seed: int | None
    scenario: Scenario


@dataclass(frozen=True)
class Comparison:
    """A comparison, from :func:`load_comparison`.

    Attributes:
        name: short name.
        description: what it shows.
        laws: names of the laws, in the order of the file.
        cases: names of the cases.
        runs: all runs, case by case and law by law.
    """

    name: str
    description: str
    laws: tuple[str, ...]
    cases: tuple[str, ...]
    runs: tuple[Run, ...]


def load_comparison(source: str | Path | Mapping[str, Any]) -> Comparison:
    """Load a comparison; every run of it is checked before any is made.

    Args:
        source: a file, the name of a shipped comparison such as ``coordination``, or what would stand in a file as a
            mapping; ``scenario`` may then be a Scenario.

    Raises:
        ScenarioError: with file and line of what is wrong.
    """
    if isinstance(source, Mapping):
        document, folder = mapped_document("the comparison", source), Path()
    else:
        path = find_file(source, shipped_comparisons(), "comparison")
        document, folder = parse(read_text(path), str(path)), path.parent
    if faults := list(value_faults(document.data)):
        raise document.attributed(faults)
    model = parsed(document, ComparisonFile, SECTIONS)
    if faults := [*_doubles(model), *_overlaps(model), *_size_faults(model)]:
        raise document.attributed(faults)
    base = base_document(document, model.scenario, model.set, folder)
    runs = tuple(_runs(document, model, base))
    laws, cases = (tuple(variant.name for variant in variants) for variants in (model.laws, model.cases))
    return Comparison(model.name, model.description, laws, cases, runs)


def shipped_comparisons() -> dict[str, Path]:
    """Files of the comparisons that come with the package, by name."""
    return shipped("comparison")


def _runs(document: Document, model: ComparisonFile, base: Document) -> Iterator[Run]:
    faults: dict[str, Fault] = {}
    for c, case in enumerate(model.cases):
        for k, law in enumerate(model.laws):
            for number, seed in enumerate(model.seeds or (None,)):
                try:
                    # A case may change a field of a section that a law replaces: the obstacles, say.
                    changed = with_values(base, law.set, _origins(document, "laws", k, law))
                    changed = with_values(changed, case.set, _origins(document, "cases", c, case))
                    if seed is not None:
                        changed = with_values(changed, {SEED: seed}, {SEED: document.origin(("seeds", number))})
                    yield Run(law.name, case.name, seed, validate(changed))
                except ScenarioError as error:
                    faults |= {str(fault): fault for fault in error.faults}
    if faults:
        raise ScenarioError(faults.values())


def _origins(document: Document, key: str, index: int, variant: Variant) -> dict[str, str]:
    return {path: document.origin((key, index, "set", path)) for path in variant.set}


def _doubles(model: ComparisonFile) -> Iterator[Fault]:
    """Two laws, or two cases, of one name."""
    for key, variants in (("laws", model.laws), ("cases", model.cases)):
        seen: set[str] = set()
        for index, variant in enumerate(variants):
            if variant.name in seen:
                yield Fault((key, index, "name"), "another one has this name", variant.name)
            seen.add(variant.name)


def _overlaps(model: ComparisonFile) -> Iterator[Fault]:
    """A case that replaces what a law sets, which would then be the same law in another name."""
    for c, case in enumerate(model.cases):
        for path in case.set:
            laws = [law.name for law in model.laws if any(f"{its}.".startswith(f"{path}.") for its in law.set)]
            if laws:
                yield Fault(("cases", c, "set", path), f"replaces what law {laws[0]!r} sets")


def _size_faults(model: ComparisonFile) -> Iterator[Fault]:
    runs = len(model.laws) * len(model.cases) * max(len(model.seeds), 1)
    if runs > MOST_RUNS:
        yield Fault((), f"{runs} runs", allowed=f"at most {MOST_RUNS}; sweeps may have more")
