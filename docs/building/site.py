"""The site: pages gathered from all over the project, built by Zensical, their formulas drawn."""

import shutil
import subprocess
import sys
from pathlib import Path, PurePosixPath

from building.api import api_pages
from building.claims import claims_page
from building.command import command_page
from building.formulas import draw_formulas
from building.links import Links
from building.notebooks import notebook_page, notebooks_page
from building.part_tables import metrics_page, parts_page
from building.scenario_tables import scenario_page
from building.sources import source_page
from drake_formation.analysis import NOT_COVERED

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
OUT = ROOT / "out" / "docs"
CONFIGURATION = "zensical.toml"


class BuildError(RuntimeError):
    """Zensical found something wrong, and has said what."""


def build(out: Path = OUT) -> Path:
    """Build the site.

    Args:
        out: where; what is there goes.

    Returns:
        Its first page.

    Raises:
        BrokenLinkError: a link of a page leads nowhere in the project.
        BuildError: Zensical has warned.
    """
    shutil.rmtree(out, ignore_errors=True)
    gather(out / "pages")
    _write(out / "not_covered.md", "".join(f"- {words}\n" for words in NOT_COVERED))
    _write(out / CONFIGURATION, configuration())
    program = Path(sys.executable).with_name("zensical")
    if subprocess.run([program, "build", "--strict", "--clean"], cwd=out, check=False).returncode:
        raise BuildError("the site is not built: Zensical warned of the above")
    for page in sorted((out / "site").rglob("*.html")):
        page.write_text(draw_formulas(page.read_text(encoding="utf-8")), encoding="utf-8")
    return out / "site" / "index.html"


def configuration() -> str:
    """Zensical's configuration, with all that ``docs/zensical.toml`` leaves open."""
    packages = ", ".join(f'"reference/{name}.md"' for name in api_pages())
    text = (DOCS / CONFIGURATION).read_text(encoding="utf-8")
    return text.replace("[PYTHON]", f"[{packages}]").replace('"ROOT', f'"{ROOT.as_posix()}')


def gather(folder: Path) -> None:
    """Write all pages, with their links and what they lead to.

    Raises:
        BrokenLinkError: a link leads nowhere.
    """
    texts = {**written_pages(), **generated_pages()}
    links = Links(ROOT, {file: page for file, (page, _) in texts.items()})
    for file, (page, text) in texts.items():
        _write(folder / page, links.of_site(text, file, page))
    for file, page in links.shown.items():
        _write(folder / page, source_page(file, file.relative_to(ROOT).as_posix()))
    for picture, place in links.pictures.items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(picture, folder / place)
    shutil.copytree(DOCS / "assets", folder / "assets", dirs_exist_ok=True)
    links.require_all()


def written_pages() -> dict[Path, tuple[PurePosixPath, str]]:
    """The pages that somebody wrote: page and text by file."""
    places = {file: file.relative_to(DOCS) for file in sorted(DOCS.rglob("*.md"))}
    places |= {ROOT / "README.md": Path("readme.md"), ROOT / "tests/benchmarks/README.md": Path("benchmarks.md")}
    return {file: (PurePosixPath(place), file.read_text(encoding="utf-8")) for file, place in places.items()}


def generated_pages() -> dict[Path, tuple[PurePosixPath, str]]:
    """The pages made of the code: page and text by the file in ``docs/`` that they stand for."""
    notebooks = sorted((ROOT / "notebooks").glob("*.ipynb"))
    pages = {
        "notebooks.md": notebooks_page(notebooks),
        "claims.md": claims_page(ROOT),
        "reference/scenario.md": scenario_page(),
        "reference/parts.md": parts_page(ROOT),
        "reference/metrics.md": metrics_page(),
        "reference/command.md": command_page(),
        **{f"reference/{name}.md": text for name, text in api_pages().items()},
    }
    made = {DOCS / name: (PurePosixPath(name), text) for name, text in pages.items()}
    for file in notebooks:
        made[file] = PurePosixPath("notebooks", f"{file.stem}.md"), notebook_page(file)
    return made


def _write(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
