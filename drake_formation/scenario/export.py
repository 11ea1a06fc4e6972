"""Scenarios written out: as YAML with every default spelled out, and their schema for editors."""

import io
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.nodes import ScalarNode, SequenceNode
from ruamel.yaml.representer import SafeRepresenter

from drake_formation.config.json_schema import schema_of
from drake_formation.scenario.schema import Scenario
from drake_formation.shipped import schema_line


def to_yaml(scenario: Scenario) -> str:
    """A scenario as YAML, every default spelled out; loading it gives an equal scenario."""
    yaml: Any = YAML(typ="safe", pure=True)
    yaml.Representer = _Representer
    yaml.default_flow_style = False
    yaml.sort_base_mapping_type_on_output = False  # the schema's order
    yaml.allow_unicode = True
    yaml.width = 120
    text = io.StringIO()
    yaml.dump(scenario.model_dump(), text)
    return text.getvalue()


def dump_scenario(scenario: Scenario, path: str | Path) -> None:
    """Write a scenario to a file as :func:`to_yaml` gives it, with a line by which editors find its schema.

    Raises:
        OSError: the file cannot be written.
    """
    Path(path).write_text(schema_line("scenario") + to_yaml(scenario), encoding="utf-8")


def json_schema() -> dict[str, Any]:
    """JSON Schema of scenario files; see :mod:`drake_formation.config.json_schema`."""
    return schema_of(Scenario, "drake_formation scenario")


class _Representer(SafeRepresenter):
    """Points, edges and matrices on one line; lists of sections on a line each."""

    def represent_tuple(self, data: tuple[Any, ...]) -> SequenceNode:
        block = any(isinstance(item, dict) for item in data)
        return self.represent_sequence("tag:yaml.org,2002:seq", data, flow_style=not block)

    def represent_text(self, data: str) -> ScalarNode:
        # Left plain, some line separators of Unicode would come back as spaces.
        return self.represent_scalar("tag:yaml.org,2002:str", data, style=None if data.isprintable() else '"')

    def ignore_aliases(self, data: Any) -> bool:  # noqa: ARG002 (the base class's signature)
        """Equal points are written out, not as references to each other."""
        return True


_Representer.add_representer(tuple, _Representer.represent_tuple)
_Representer.add_representer(str, _Representer.represent_text)
