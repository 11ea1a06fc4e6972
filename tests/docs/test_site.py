"""The site builds without a warning, and reads from the file system: nothing comes from elsewhere, and search works."""

import re
import tomllib

import pytest
from browsing import chromium, page_address
from building.formulas import draw_formulas
from building.links import BrokenLinkError, Links
from building.scenario_tables import scenario_page, value_text
from building.site import DOCS, ROOT, build, configuration, gather, generated_pages, written_pages

from drake_formation.parts import kinds
from drake_formation.parts.roles import ROLES

SEARCH = "[...document.querySelectorAll('*')].map(each => each.shadowRoot).find(root => root)"
"""The search, which is in a tree of its own within the page."""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return build(tmp_path_factory.mktemp("docs")).parent


@pytest.mark.slow
def test_it_reads_offline(site):
    driver = chromium()
    try:
        for page in ("index.html", "theory/index.html", "reference/scenario.html"):
            driver.get(page_address(site / page))
            assert driver.find_element("tag name", "h1").text
            assert not driver.get_log("browser")
        pictures = driver.execute_script(
            "return [...document.images].filter(i => i.complete && !i.naturalWidth).length"
        )
        assert not pictures
    finally:
        driver.quit()


@pytest.mark.slow
def test_search_finds_a_page_without_a_server(site):
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.support.ui import WebDriverWait

    driver = chromium()
    try:
        driver.get(page_address(site / "index.html"))
        wait = WebDriverWait(driver, 20)
        wait.until(lambda it: it.find_element("css selector", ".md-search__button")).click()
        wait.until(lambda it: it.execute_script(f"return {SEARCH} && {SEARCH}.activeElement"))
        ActionChains(driver).send_keys("mecanum").perform()
        wait.until(lambda it: it.execute_script(f"return {SEARCH}.querySelector('a[href*=\"h=mecanum\"]')"))
        assert not driver.get_log("browser")
    finally:
        driver.quit()


def test_every_page_is_in_the_navigation():
    def pages(entries):
        for entry in entries:
            for value in entry.values() if isinstance(entry, dict) else [entry]:
                yield from pages(value) if isinstance(value, list) else [value]

    navigation = set(pages(tomllib.loads(configuration())["project"]["nav"]))
    there = {page.as_posix() for page, _ in [*written_pages().values(), *generated_pages().values()]}
    assert navigation == {page for page in there if not page.startswith("notebooks/")}


def test_links_lead_to_pages_lines_and_pictures_or_are_refused():
    index = DOCS / "index.md"
    page = written_pages()[index][0]
    links = Links(ROOT, {index: page})
    text = links.of_site("[a](../drake_formation/diagram.py#build_diagram) ![b](../diagrams/view.png)", index, page)
    lines = (ROOT / "drake_formation/diagram.py").read_text(encoding="utf-8").splitlines()
    (number,) = re.findall(r"#__codelineno-0-(\d+)", text)
    assert lines[int(number) - 1].startswith("def build_diagram(")
    assert "](source/drake_formation/diagram.py.md#" in text
    assert "](assets/diagrams/view.png)" in text
    links.require_all()
    for wrong in ("nowhere.md", "../drake_formation/diagram.py#nothing"):
        broken = Links(ROOT, {index: page})
        broken.of_site(f"[c]({wrong})", index, page)
        with pytest.raises(BrokenLinkError, match=re.escape(wrong.partition("#")[0])):
            broken.require_all()


def test_code_is_no_link():
    page = written_pages()[DOCS / "index.md"][0]
    text = "```python\na[0](nowhere.md)\n```\n"
    links = Links(ROOT, {})
    assert links.of_site(text, DOCS / "index.md", page) == text
    links.require_all()


def test_a_formula_is_a_picture_with_its_latex():
    drawn = draw_formulas(r'<p>so <span class="arithmatex">\(\frac{a}{b} &lt; 1\)</span></p>')
    assert "<svg" in drawn
    assert r"\frac{a}{b} &lt; 1" in drawn
    with pytest.raises(ValueError, match="unknowncommand"):
        draw_formulas(r'<span class="arithmatex">\(\unknowncommand\)</span>')


def test_every_kind_has_its_table():
    page = scenario_page()
    for role in ROLES:
        for kind, part in kinds(role).items():
            if part.distribution == "drake-formation":
                assert f"`{kind}` {{ #" in page, (role, kind)


@pytest.mark.parametrize(
    ("field", "words"),
    [
        ({"type": "number", "exclusiveMinimum": 0}, "number > 0"),
        ({"enum": ["a", "b"]}, "`a`, `b`"),
        ({"anyOf": [{"type": "integer"}, {"type": "null"}]}, "whole number"),
        ({"oneOf": [{"type": "number"}, {"additionalProperties": {"type": "number"}}]}, "number, *each*"),
    ],
)
def test_values_in_words(field, words):
    assert value_text(field) == words


def test_every_link_leads_somewhere(tmp_path):
    gather(tmp_path)
    assert (tmp_path / "source/drake_formation/parts/springs/hookean.py.md").exists()


def test_a_law_of_the_theory_is_named_as_in_the_code():
    for page in sorted((DOCS / "theory").glob("*.md")):
        named = re.findall(r"\[`([^`]+)`\]\([^)#]+#(\w+)\)", page.read_text(encoding="utf-8"))
        assert named
        assert all(shown == name for shown, name in named), page
