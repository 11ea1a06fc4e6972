"""Files of the project as pages."""

import ast
import re
from pathlib import Path

LANGUAGES = {".py": "python", ".yaml": "yaml", ".toml": "toml", ".ipynb": "json"}


def anchor_of(file: Path, name: str) -> str | None:
    """The anchor, on the page of a Python file, of the line where a function or class (``Class.method``) begins."""
    if file.suffix != ".py":
        return None
    scope: ast.AST = ast.parse(file.read_text(encoding="utf-8"))
    for part in name.split("."):
        found = [node for node in ast.iter_child_nodes(scope) if _defines(node, part)]
        if not found:
            return None
        scope = found[-1]
    return f"__codelineno-0-{scope.lineno}"


def _defines(node: ast.AST, name: str) -> bool:
    match node:
        case ast.FunctionDef() | ast.ClassDef():
            return node.name == name
        case ast.Assign():
            return any(isinstance(target, ast.Name) and target.id == name for target in node.targets)
        case ast.AnnAssign():
            return isinstance(node.target, ast.Name) and node.target.id == name
    return False


def source_page(file: Path, name: str) -> str:
    """A file, or the names in a folder, as a page that the search leaves out."""
    heading = f"---\nsearch:\n  exclude: true\n---\n\n# `{name}`\n\n"
    if file.is_dir():
        names = sorted(part.relative_to(file).as_posix() for part in file.rglob("*") if _is_source(part))
        return heading + "\n".join(f"- `{name}`" for name in names) + "\n"
    text = file.read_text(encoding="utf-8")
    longest = max(map(len, re.findall(r"^ *(`{3,})", text, re.MULTILINE)), default=2)
    fence = "`" * (longest + 1)
    return f'{heading}{fence} {{ .{LANGUAGES.get(file.suffix, "text")} linenums="1" }}\n{text.rstrip()}\n{fence}\n'


def _is_source(path: Path) -> bool:
    return path.is_file() and "__pycache__" not in path.parts
