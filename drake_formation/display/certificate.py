"""A certificate as HTML: what ``drake-formation analyze`` prints."""

import io

from rich.console import Console

from drake_formation.analysis.certificate import Certificate
from drake_formation.analysis.report import report

WIDTH = 110
"""Characters of a line."""

FORMAT = '<pre style="line-height: 1.2; font-family: monospace">{code}</pre>'


def certificate_html(certificate: Certificate) -> str:
    """A certificate for a notebook."""
    console = Console(record=True, file=io.StringIO(), width=WIDTH, markup=False, emoji=False)
    console.print(report(certificate))
    return console.export_html(inline_styles=True, code_format=FORMAT)
