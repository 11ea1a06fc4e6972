"""``python -m drake_formation``, and the command ``drake-formation``."""

from drake_formation.terminal import orderly


def main() -> None:
    """The command line, in good order from the first import on."""
    with orderly():
        from drake_formation import cli

        cli.main()


if __name__ == "__main__":
    main()
