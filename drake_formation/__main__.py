"""``python -m drake_formation``, and the command ``drake-formation``."""

import os
import sys

from drake_formation.terminal import leaving_at_once, orderly


def main() -> None:
    """The command line, in good order from the first import on."""
    with orderly():
        with leaving_at_once():
            from drake_formation import cli

            if not _is_answered_at_once():
                from drake_formation import diagram  # noqa: F401 (all of Drake that will be needed)

        cli.main()


def _is_answered_at_once() -> bool:
    """Whether the shell asks how a word goes on, or a user how the command is used: that needs nothing of Drake."""
    return "_DRAKE_FORMATION_COMPLETE" in os.environ or not {"--help", "--version"}.isdisjoint(sys.argv)


if __name__ == "__main__":
    main()
