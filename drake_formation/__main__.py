"""``python -m drake_formation``, and the command ``drake-formation``."""

from drake_formation.terminal import leaving_at_once, orderly


def main() -> None:
    """The command line, in good order from the first import on."""
    with orderly():
        with leaving_at_once():
            from drake_formation import cli, diagram  # noqa: F401 (all of Drake that will be needed)

        cli.main()


if __name__ == "__main__":
    main()
