"""The command's own help, as a page."""

from typing import Any

import click
import typer

from drake_formation.cli.app import app

NAME = "drake-formation"
WIDTH = 96
"""Characters that a page shows in a line of code."""


def command_page() -> str:
    """What every command prints for ``--help``."""
    group: Any = typer.main.get_command(app)
    parent = click.Context(group, info_name=NAME)
    parts = ["# The command", _help(group, NAME, None)]
    for name in sorted(group.commands):
        parts += [f"## {name}", _help(group.commands[name], name, parent)]
    return "\n\n".join(parts) + "\n"


def _help(command: Any, name: str, parent: Any) -> str:
    widths = {"terminal_width": WIDTH, "max_content_width": WIDTH}
    text = command.get_help(command.context_class(command, info_name=name, parent=parent, **widths))
    return f"```text\n{text.rstrip()}\n```"
