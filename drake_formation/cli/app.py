"""The command ``drake-formation``, of which each module of this folder is a part."""

import os

import typer

from drake_formation.config.errors import ScenarioError
from drake_formation.terminal import WRONG_INPUT, orderly, stop

app = typer.Typer(
    help="Cooperative transport by hierarchical decentralized LQR, as a Drake block diagram.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def main() -> None:
    """Entry point of the command; turns what a user can do wrong into a message and an exit status."""
    # Figures are files in this project's style: neither a window nor a user's settings of Matplotlib are asked for.
    os.environ |= {"MPLBACKEND": "agg", "MATPLOTLIBRC": os.devnull}
    try:
        with orderly():
            app()
    except ScenarioError as error:
        stop(str(error), WRONG_INPUT)
