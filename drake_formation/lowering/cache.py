"""Compiled modules on disk, by the text of their source.

An entry is a folder: the source, what numba keeps of the machine code beside it, and a list of checksums. It is made
under another name and moved into place when it is complete, so that several processes never see half an entry; one
whose checksums are wrong is made again.
"""

import hashlib
import importlib.util
import json
import os
import platform
import shutil
import sys
import tempfile
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from typing import Any

CHECKSUMS = "checksums.json"
MODULE = "compiled.py"
FOLDER = "DRAKE_FORMATION_CACHE_DIR"
"""Environment variable that names another cache folder."""


def load(source: str) -> ModuleType:
    """The module of a source: loaded before, from the cache, or compiled now."""
    key = _key(source)
    name = f"drake_formation_compiled_{key}"
    if name in sys.modules:
        return sys.modules[name]
    entry = cache_folder() / key
    if _is_whole(entry):
        try:
            return _imported(entry, name)
        except Exception:  # whatever a damaged entry raises, it is made anew
            shutil.rmtree(entry, ignore_errors=True)
    try:
        return _made(entry, name, source)
    except OSError:  # a cache that cannot be written costs time, nothing else
        with tempfile.TemporaryDirectory() as place:
            return _compiled(Path(place), name, source)


def cache_folder() -> Path:
    """Where compiled modules are kept: ``$DRAKE_FORMATION_CACHE_DIR``, else the user's cache folder."""
    if FOLDER in os.environ:
        return Path(os.environ[FOLDER])
    if sys.platform == "darwin":
        base = Path("~/Library/Caches").expanduser()
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser())
    return base / "drake-formation"


def _key(source: str) -> str:
    return hashlib.sha256(f"{_machine()}\n{source}".encode()).hexdigest()[:32]


@cache
def _machine() -> str:
    """Everything but the source that the machine code depends on."""
    from llvmlite import binding
    from numba import __version__ as numba_version

    features = binding.get_host_cpu_features().flatten()
    made_by = (version("drake-formation"), numba_version, sys.version, platform.machine(), binding.get_host_cpu_name())
    return "\n".join([*made_by, features])


def _made(entry: Path, name: str, source: str) -> ModuleType:
    entry.parent.mkdir(parents=True, exist_ok=True)
    place = Path(tempfile.mkdtemp(dir=entry.parent, prefix="making-"))
    try:
        module = _compiled(place, name, source)
        sums = {path.relative_to(place).as_posix(): _checksum(path) for path in place.rglob("*") if path.is_file()}
        (place / CHECKSUMS).write_text(json.dumps(sums))
        if entry.exists() and not _is_whole(entry):
            shutil.rmtree(entry, ignore_errors=True)
        if not entry.exists():
            place.rename(entry)
    except OSError:
        if not _is_whole(entry):  # else another process was quicker
            raise
    finally:
        shutil.rmtree(place, ignore_errors=True)
    return module


def _compiled(place: Path, name: str, source: str) -> ModuleType:
    (place / MODULE).write_text(source, encoding="utf-8")
    return _imported(place, name)


def _imported(place: Path, name: str) -> ModuleType:
    """Import a module, which compiles it unless numba finds the machine code beside it."""
    from numba.core import config as settings

    config: Any = settings

    spec = importlib.util.spec_from_file_location(name, place / MODULE)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    elsewhere, writes = config.CACHE_DIR, sys.dont_write_bytecode
    # The machine code belongs into the entry, whatever NUMBA_CACHE_DIR says, and Python's byte code does not.
    config.CACHE_DIR, sys.dont_write_bytecode = "", True
    sys.modules[name] = module  # numba looks the module up by its name
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    finally:
        config.CACHE_DIR, sys.dont_write_bytecode = elsewhere, writes
    return module


def _is_whole(entry: Path) -> bool:
    try:
        sums = json.loads((entry / CHECKSUMS).read_text())
        return bool(sums) and all(_checksum(entry / name) == value for name, value in sums.items())
    except (OSError, ValueError, AttributeError):
        return False


def _checksum(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
