"""The public API, as mkdocstrings reads it from the packages: what their ``__all__`` says."""

from importlib import import_module

from building.roles import in_markdown

PACKAGES = {
    "drake_formation": ["drake_formation"],
    "analysis": ["drake_formation.analysis"],
    "compare": ["drake_formation.compare"],
    "lowering": ["drake_formation.lowering"],
    "measuring": ["drake_formation.measuring"],
    "parts_api": ["drake_formation.parts"],
    "scenario_api": ["drake_formation.scenario"],
    "simulation": ["drake_formation.simulation"],
    "sweep": ["drake_formation.sweep"],
    "viz": ["drake_formation.viz", "drake_formation.viz.view"],
}
"""Packages by the page that has them."""


def api_pages() -> dict[str, str]:
    """Page by page, every public name of its packages."""
    return {page: "\n\n".join(map(_package, names)) + "\n" for page, names in PACKAGES.items()}


def _package(name: str) -> str:
    package = import_module(name)
    public = [f"::: {name}.{member}" for member in package.__all__]
    return "\n\n".join([f"# `{name}`", in_markdown(package.__doc__ or ""), *public])
