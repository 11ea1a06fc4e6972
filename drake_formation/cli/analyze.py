"""``drake-formation analyze``: a certificate before anything is simulated."""

from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.app import command
from drake_formation.cli.options import Format, FormatName, Overrides, Source, path
from drake_formation.terminal import WRONG_INPUT, detail, report, stop


@command()
def analyze(
    scenario: Source,
    overrides: Overrides = None,
    out: Annotated[
        Path | None,
        typer.Option(parser=path, metavar="FOLDER", help="For the certificate and its figures, if wanted."),
    ] = None,
    file_format: Format = FormatName.PNG,
    period: Annotated[float | None, typer.Option(help="Sampling period of the loss margin (s).")] = None,
    damping_ratio: Annotated[float | None, typer.Option(help="Find the smallest δ with this damping ratio.")] = None,
    decay_rate: Annotated[float | None, typer.Option(help="Find the smallest δ with this decay rate (1/s).")] = None,
    force_limit: Annotated[float | None, typer.Option(help="Find the largest δ under this force (N).")] = None,
    topology: Annotated[float | None, typer.Option(help="Find the fewest channels for this error (m).")] = None,
) -> None:
    """Certify a scenario before it is simulated: stability, modes, margins and what disturbances do."""
    from drake_formation.analysis import IllPosedError, Questions, certify
    from drake_formation.analysis.report import report as in_words
    from drake_formation.cli.certificate_folder import CERTIFICATE, write_certificate
    from drake_formation.places import PICTURES, OutputError, reserved
    from drake_formation.scenario import load_scenario
    from drake_formation.terminal.tables import progress_console

    resolved = load_scenario(scenario, overrides=overrides)

    def tell(part: str) -> None:
        status.update(f"analyzing: {part}")
        detail(f"analyzing: {part}")

    try:
        asked = Questions(period, damping_ratio, decay_rate, force_limit, topology)
        with (
            reserved(out, CERTIFICATE) if out else nullcontext() as place,
            progress_console().status("linearizing", spinner="line") as status,
        ):
            certificate = certify(resolved, questions=asked, progress=tell)
            written = place and write_certificate(place, certificate, file_format.value)
    except (OutputError, IllPosedError) as error:
        stop(str(error), WRONG_INPUT)
    where = f"Certificate in {written.folder}, figures in {written.folder / PICTURES}." if written else ""
    remarks = written.remarks() if written else []
    verdict = {True: "stable", False: "unstable", None: "not certified"}[certificate.stable]
    report(
        certificate.to_dict() | {"folder": written and written.folder, "remarks": remarks},
        in_words(certificate),
        *(["\n".join([*remarks, where])] if written else []),
        short=verdict,
    )
