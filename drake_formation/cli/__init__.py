"""The command line: ``drake-formation run | view | export | sweep | analyze | validate | graphviz | reproduce | …``.

One command a file, beside it what it writes: ``run`` and ``run_folder``, ``analyze`` and ``certificate_folder``.
``app`` is the command that they are parts of, and ``options`` what several of them take.
"""

from drake_formation.cli import (  # noqa: I001 (in the order in which --help lists them)
    run, view, export, sweep, compare, analyze, validate, graphviz, reproduce, schema, scenarios, parts, metrics,  # noqa: F401
)  # fmt: skip
from drake_formation.cli.app import app, main

__all__ = ["app", "main"]
