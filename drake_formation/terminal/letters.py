"""Text for any encoding: what it lacks is spelt out in ASCII, by the error handler ``transliterate``."""

import codecs
import unicodedata

_ASCII = {
    "≤": "<=", "≥": ">=", "≠": "!=", "≈": "~", "−": "-", "–": "-", "—": "-", "×": "x", "·": ".", "√": "sqrt", "‖": "||",
    "∞": "inf", "→": "->", "←": "<-", "±": "+/-", "…": "...", "“": '"', "”": '"', "‘": "'", "’": "'", "°": " deg",
    "∈": "in", "µ": "u", "¹": "^1", "²": "^2", "³": "^3", "⁻": "^-", "─": "-", "━": "-", "│": "|", "┃": "|",
}  # fmt: skip
"""ASCII for what this package prints, beside Greek letters, which become their names, and accents, which go."""


def _transliterated(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_in_ascii, error.object[error.start : error.end])), error.end


def _in_ascii(character: str) -> str:
    if character in _ASCII:
        return _ASCII[character]
    words = unicodedata.name(character, "").split()
    if words[:1] == ["GREEK"] and words[2:3] == ["LETTER"]:
        return words[3].lower() if words[1] == "SMALL" else words[3].capitalize()
    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return plain or character.encode("ascii", "backslashreplace").decode()


codecs.register_error("transliterate", _transliterated)
