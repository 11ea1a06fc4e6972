"""Deprecations warn for one minor version, and not longer."""

from importlib.metadata import version
from pathlib import Path

import pytest

from drake_formation.deprecation import ALL, Deprecation


def numbers(text):
    return [int(number) for number in text.split(".")[:2]]


def test_a_deprecation_says_since_when_until_when_and_what_instead():
    goes = Deprecation("this", "1.9", "use that")
    assert str(goes) == "this is deprecated since 1.9 and goes with 1.10: use that."

    def what_goes():
        goes.warn()

    with pytest.warns(DeprecationWarning, match="use that") as caught:
        what_goes()
    assert caught[0].filename == __file__


@pytest.mark.parametrize("deprecation", ALL, ids=lambda deprecation: deprecation.what)
def test_none_outlives_its_time(deprecation):
    assert numbers(deprecation.since) <= numbers(version("drake-formation")) < numbers(deprecation.gone_in)


@pytest.mark.parametrize("deprecation", ALL, ids=lambda deprecation: deprecation.what)
def test_the_page_on_versions_has_it(deprecation):
    page = (Path(__file__).parents[1] / "docs" / "versions.md").read_text(encoding="utf-8")
    instead = deprecation.instead.removeprefix("use ")
    assert f"| `{deprecation.what}` | {deprecation.since} | {deprecation.gone_in} | `{instead}` |" in page
