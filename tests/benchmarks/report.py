"""Runs the benchmarks, all or those named, and writes their tables into README.md: ``make bench``."""

import io
import platform
import sys
from collections.abc import Callable
from contextlib import redirect_stdout
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import bench
import first_use
import lowered
import sweep_peers
import sweeps
import whole_runs

README = Path(__file__).with_name("README.md")
VERSIONS = ("drake", "numba", "numpy", "scipy", "control", "bdsim", "pathsim", "diffrax", "heyoka", "casadi", "jax")

PARTS: dict[str, Callable[[], None]] = {
    "blocks": bench.compare_derivatives,
    "block-runs": bench.compare_runs,
    "derivatives": lowered.compare_derivatives,
    "first-use": first_use.compare,
    "runs": lambda: whole_runs.compare(whole_runs.Job()),
    "methods": whole_runs.compare_methods,
    "sweeps": sweep_peers.main,
    "memory": lambda: sweeps.watch_memory(10_000),
}


class Tee(io.StringIO):
    """Keeps what is printed, and prints it."""

    def __init__(self, other):
        super().__init__()
        self._other = other

    def write(self, text):
        self._other.write(text)
        self._other.flush()
        return super().write(text)


def measured(part):
    """What a benchmark prints."""
    with redirect_stdout(Tee(sys.stdout)) as printed:
        part()
    return printed.getvalue().strip()


def conditions():
    """On what it was measured."""

    def known(package):
        try:
            return f"{package} {version(package)}"
        except PackageNotFoundError:
            return f"no {package}"

    return f"Python {platform.python_version()}, {', '.join(map(known, VERSIONS))}"


def write(name, text):
    """Replace a part of the README, which stands between two comments."""
    begin, end = f"<!-- {name} -->\n", f"\n<!-- /{name} -->"
    document = README.read_text(encoding="utf-8")
    head, rest = document.split(begin, 1)
    _, tail = rest.split(end, 1)
    README.write_text(f"{head}{begin}{text}{end}{tail}", encoding="utf-8")


def main():
    wanted = sys.argv[1:] or list(PARTS)
    if unknown := set(wanted) - PARTS.keys():
        raise SystemExit(f"no benchmark {', '.join(sorted(unknown))}; there are {', '.join(PARTS)}")
    for name in wanted:
        write(name, measured(PARTS[name]))
        print(flush=True)
    write("conditions", conditions())


if __name__ == "__main__":
    main()
