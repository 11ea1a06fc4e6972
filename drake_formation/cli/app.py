"""The command ``drake-formation``, of which each module of this folder is a part."""

import dataclasses
import functools
import inspect
import os
from collections.abc import Callable
from importlib.metadata import version
from typing import Annotated, Any

import typer

from drake_formation.config.errors import ScenarioError
from drake_formation.sources import OWN
from drake_formation.terminal import MANNER, WRONG_INPUT, orderly, say, stop

app = typer.Typer(
    help="Cooperative transport by hierarchical decentralized LQR, as a Drake block diagram.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

Json = Annotated[bool, typer.Option("--json", help="Answer with one JSON document, and nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Say nothing but errors and the bare answer.")]
Verbose = Annotated[bool, typer.Option("--verbose", "-v", help="Say what is done when, on standard error.")]


def command(
    name: str | None = None, *, answers: bool = True, hidden: bool = False
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Make a function a command that takes, beside its own options, those by which all are told how to speak.

    Args:
        name: of the command; the function's own if not given.
        answers: whether it can answer with a JSON document.
        hidden: whether ``--help`` leaves it out.
    """
    manner: dict[str, tuple[Any, Any]] = {"as_json": (Json, False)} if answers else {}
    manner |= {"quiet": (Quiet, False), "verbose": (Verbose, False)}

    def registered(function: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(function)
        def told_how(**given: Any) -> None:
            _speak(**{option: given.pop(option) for option in manner})
            function(**given)

        own = inspect.signature(function, eval_str=True)
        added = [
            inspect.Parameter(option, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)
            for option, (kind, default) in manner.items()
        ]
        told_how.__signature__ = own.replace(parameters=[*own.parameters.values(), *added])  # type: ignore[attr-defined]
        told_how.__annotations__ = function.__annotations__ | {option: kind for option, (kind, _) in manner.items()}
        app.command(name, hidden=hidden)(told_how)
        return function

    return registered


def _speak(*, as_json: bool = False, quiet: bool = False, verbose: bool = False) -> None:
    """Take up what was asked of the manner to speak, before or after the command's name."""
    MANNER.as_json |= as_json
    MANNER.quiet |= quiet
    if verbose:
        MANNER.go_into_details()
    if MANNER.quiet and MANNER.at_length:
        stop("--quiet and --verbose ask for different things; give one of them", WRONG_INPUT)


def _versions(asked: bool) -> None:
    if asked:
        from platform import python_version

        say("\n".join(f"{name} {number}" for name, number in [
            (OWN, version(OWN)), ("Drake", version("drake")), ("Python", python_version()),
        ]))  # fmt: skip
        raise typer.Exit


@app.callback()
def _options(
    _version: Annotated[
        bool, typer.Option("--version", callback=_versions, is_eager=True, help="Say which versions these are.")
    ] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    _speak(quiet=quiet, verbose=verbose)


def main() -> None:
    """Entry point of the command; turns what a user can do wrong into a message and an exit status."""
    # Figures are files in this project's style: neither a window nor a user's settings of Matplotlib are asked for.
    os.environ |= {"MPLBACKEND": "agg", "MATPLOTLIBRC": os.devnull}
    MANNER.reset()
    try:
        with orderly():
            app()
    except ScenarioError as error:
        stop(str(error), WRONG_INPUT, [dataclasses.asdict(fault) for fault in error.faults])
