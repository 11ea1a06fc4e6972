"""Compiled modules on disk, by the text of their source.

An entry is a folder: the source, what numba keeps of the machine code beside it, and a list of checksums. It is made
under another name and moved into place when it is complete, so that several processes never see half an entry; one
whose checksums are wrong is made again. In one process modules are made one after the other, and nobody sees one that
is not complete.

The text is all that is compiled: it imports nothing of this package, at the most other modules made here, whose names
tell their text. So an entry is known by the text and by what turns it into machine code, and a changed package that
writes another text has another entry.

Machine code from a folder that others may write to would be theirs to choose: such a folder is not read. A folder that
is made here is its user's alone.
"""

import hashlib
import importlib.util
import json
import os
import platform
import shutil
import stat
import sys
import tempfile
import threading
import warnings
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from typing import Any

CHECKSUMS = "checksums.json"
MODULE = "compiled.py"
OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
FOLDER = "DRAKE_FORMATION_CACHE_DIR"
"""Environment variable that names another cache folder."""


_loaded: dict[str, ModuleType] = {}
_LOADING = threading.RLock()


def load(source: str) -> ModuleType:
    """The module of a source: loaded before, from the cache, or compiled now. Any number of threads may ask."""
    key = _key(source)
    if key not in _loaded:
        with _LOADING:
            if key not in _loaded:
                _loaded[key] = _found(key, source)
    return _loaded[key]


def _found(key: str, source: str) -> ModuleType:
    name, folder = f"drake_formation_compiled_{key}", cache_folder()
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _is_own(folder):
            _warn_of(folder)
            return _compiled_aside(name, source)
        entry = folder / key
        if _is_whole(entry):
            try:
                return _imported(entry, name)
            except Exception:  # whatever a damaged entry raises, it is made anew
                _remove(entry)
        return _made(entry, name, source)
    except OSError:  # a cache that cannot be written costs time, nothing else
        return _compiled_aside(name, source)


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

    features = binding.get_host_cpu_features().flatten()
    versions = (version(package) for package in ("numba", "llvmlite", "numpy"))
    made_by = (*versions, sys.version, platform.machine(), binding.get_host_cpu_name())
    return "\n".join([*made_by, features])


def _is_own(folder: Path) -> bool:
    """Whether a folder is this user's, and nobody else may write to it."""
    state = folder.stat()
    return not hasattr(os, "geteuid") or (state.st_uid == os.geteuid() and not state.st_mode & OTHERS_WRITE)


@cache
def _warn_of(folder: Path) -> None:
    """Say once that a folder is not used."""
    message = f"{folder} is another user's or may be written to by others, so compiled code is not kept there; "
    warnings.warn(f"{message}make it yours alone (chmod 700), or name another folder by {FOLDER}", stacklevel=2)


def _compiled_aside(name: str, source: str) -> ModuleType:
    """Compiled for this process alone; numba keeps nothing of it, for which there may be no room either."""
    with tempfile.TemporaryDirectory() as place:
        return _compiled(Path(place), name, source.replace("cache=True", "cache=False"))


def _remove(entry: Path) -> None:
    """Remove what stands in an entry's place, whatever it is."""
    if entry.is_dir() and not entry.is_symlink():
        shutil.rmtree(entry, ignore_errors=True)
    else:
        entry.unlink(missing_ok=True)


def _made(entry: Path, name: str, source: str) -> ModuleType:
    place = Path(tempfile.mkdtemp(dir=entry.parent, prefix="making-"))
    try:
        module = _compiled(place, name, source)
        sums = {path.relative_to(place).as_posix(): _checksum(path) for path in place.rglob("*") if path.is_file()}
        (place / CHECKSUMS).write_text(json.dumps(sums))
        if not _is_whole(entry):
            _remove(entry)
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
        if entry.is_symlink() or not _is_own(entry):
            return False
        sums = json.loads((entry / CHECKSUMS).read_text())
        return bool(sums) and all(_checksum(entry / name) == value for name, value in sums.items())
    except (OSError, ValueError, AttributeError):
        return False


def _checksum(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
