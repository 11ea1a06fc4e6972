"""The package's own sources as one number: results kept on disk say by it which code made them."""

import functools
import hashlib
from pathlib import Path


@functools.cache
def source_hash() -> str:
    """SHA-256 of all Python files of the package as they are at the first call, 64 hexadecimal digits.

    Names and contents count, folders and times do not, so that two installations of the same code agree.
    """
    return hash_of(Path(__file__).parent)


def hash_of(folder: Path) -> str:
    """SHA-256 of all Python files under a folder, by their names relative to it and what they hold."""
    result = hashlib.sha256()
    files = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*.py")}
    for name in sorted(files):
        content = files[name].read_bytes()
        result.update(f"{name}\n{len(content)}\n".encode())
        result.update(content)
    return result.hexdigest()
