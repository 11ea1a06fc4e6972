"""The scenario to start from says what the schema says, and runs."""

import re
from itertools import pairwise

import pytest

from drake_formation.config.errors import ScenarioError
from drake_formation.config.values import Section
from drake_formation.scenario import load_scenario, shipped_scenarios
from drake_formation.scenario.source import Document, parse
from drake_formation.scenario.starter import EXAMPLE, renamed, starter
from drake_formation.scenario.validate import validate

OUT = re.compile(r"(?m)^( *)# (\w+:.*)$")


def uncommented(text):
    head, _, body = text.partition("\n\n")
    return head + "\n\n" + OUT.sub(r"\1\2", body)


def loaded(text):
    return validate(parse(text, "starter.yaml"))


def test_it_is_the_example_and_nothing_else():
    assert loaded(starter("mine")) == validate(Document("an example", {"name": "mine", **EXAMPLE}))


def test_all_that_is_commented_out_are_the_defaults():
    text = starter("mine")
    assert len(OUT.findall(text)) > 25
    assert loaded(uncommented(text)) == loaded(text)


def test_every_line_may_be_taken_in_alone():
    text = starter("mine")
    expected = loaded(text)
    for line in OUT.finditer(text):
        one = text[: line.start()] + line[1] + line[2] + text[line.end() :]
        assert loaded(one) == expected, line[0]


def test_every_field_there_is_is_explained():
    scenario = loaded(starter("mine"))
    lines = starter("mine").splitlines()
    keys = {line.strip().removeprefix("# ").partition(":")[0] for line in lines if not line.strip().startswith("##")}

    def own(section):
        for key, value in section:
            yield key
            if isinstance(value, Section):
                yield from own(value)

    assert set(own(scenario)) <= keys
    for before, line in pairwise(lines):
        if re.match(r" *(# )?\w+:", line):
            assert before.lstrip().startswith("##"), line


def test_a_name_that_is_none_is_refused():
    for make in (starter, lambda name: renamed("line", name)):
        with pytest.raises(ScenarioError, match="name"):
            make("my scenario")


@pytest.mark.parametrize("name", shipped_scenarios())
def test_a_shipped_one_under_another_name_is_the_same(name):
    text = renamed(name, "mine")
    assert loaded(text) == load_scenario(name, overrides={"name": "mine"})
    assert text.count("yaml-language-server") == 1
