"""The command line: ``drake-formation run | view | new | show | export | sweep | analyze | validate | list | …``.

One command a file, beside it what it writes: ``run`` and ``run_folder``, ``analyze`` and ``certificate_folder``.
``app`` is the command that they are parts of, ``options`` what several of them take, and ``completion`` what the shell
offers while one is typed.
"""

from drake_formation.cli import (  # noqa: I001 (in the order in which --help lists them)
    run, view, new, show, validate, export, sweep, compare, analyze, graphviz, reproduce, listing, schema,  # noqa: F401
    deprecated,  # noqa: F401
)  # fmt: skip
from drake_formation.cli.app import app, main

__all__ = ["app", "main"]
