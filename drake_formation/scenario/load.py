"""Loading scenarios: the shipped ones by name, others from files, and variants of them."""

import logging
from collections.abc import Mapping
from pathlib import Path

from drake_formation.config.errors import Fault, ScenarioError, nearest
from drake_formation.scenario.overrides import Overrides, apply, plain
from drake_formation.scenario.schema import Scenario
from drake_formation.scenario.source import Document, read
from drake_formation.scenario.validate import validate
from drake_formation.shipped import shipped

LOG = logging.getLogger(__name__)


def load_scenario(source: str | Path, *, overrides: Overrides | None = None) -> Scenario:
    """Load a scenario.

    Args:
        source: a file, or the name of a shipped scenario such as ``line``. A file of that name comes first.
        overrides: values to replace, as dotted paths to values (``{"springs.stiffness": 3e4}``) or as texts
            ``PATH=VALUE`` with VALUE in YAML.

    Returns:
        The scenario, sound in every respect that can be checked before it is simulated.

    Raises:
        ScenarioError: with all faults found, each with file and line or with the override it came from.
    """
    file = find_file(source, shipped_scenarios(), "scenario")
    LOG.info("scenario: %s", file)
    return validate(apply(read(file), overrides))


def with_overrides(scenario: Scenario, overrides: Overrides) -> Scenario:
    """A variant of a scenario.

    Args:
        scenario: left as it is.
        overrides: as for :func:`load_scenario`.

    Raises:
        ScenarioError: with all faults of the variant.
    """
    return validate(apply(Document(_called(scenario), plain(scenario)), overrides))


def shipped_scenarios() -> dict[str, Path]:
    """Files of the scenarios that come with the package, by name."""
    return shipped("scenario")


def find_file(source: str | Path, known: Mapping[str, Path], kind: str) -> Path:
    """A file, or a shipped one by its name; a file of that name comes first.

    Args:
        source: the file or name.
        known: what comes with the package, by name.
        kind: what it is to be, for the message.

    Raises:
        ScenarioError: there is neither.
    """
    path = Path(source)
    try:
        exists, folder = path.exists(), path.is_dir()
    except (OSError, ValueError) as error:
        raise ScenarioError([Fault((), f"not a usable path: {error}", origin=str(source) or repr(source))]) from error
    if exists and not folder:
        return path
    if str(source) in known:
        return known[str(source)]
    message = "a folder, not a file" if folder else f"no such file or shipped {kind}"
    allowed = f"a file, {', '.join(known)}"
    raise ScenarioError(
        [Fault((), message, "", allowed, nearest(path.stem, known), origin=str(source) or repr(source))]
    )


def _called(scenario: Scenario) -> str:
    return f"scenario {scenario.name!r}"
