"""Names and units of fields, which their descriptions say: ``mass m_i (kg), one for all or one a robot``."""

import re

_ATOM = "(?:1|deg|kg|m|s|N|rad|Hz|V|A|W|J|bit|dBm|dB)[²³⁴]?"
_SINGLE = rf"{_ATOM}(?:[ /](?:{_ATOM}|\({_ATOM}(?: {_ATOM})*\)))*"
_UNIT = re.compile(rf"\(({_SINGLE}(?:, {_SINGLE})*)\)")

LONGEST_NAME = 40
"""Of letters; what is longer is a sentence."""

_NO_NOUNS = {"how", "when", "where", "what", "which", "who", "whether", "by", "of", "to", "at", "with", "from", "after"}
"""With which a description begins that is a sentence."""


def unit_of(description: str) -> str:
    """The unit that a description gives in parentheses, the first one; 1 for a plain number, empty for none.

    Where a field's numbers differ in it, as those of a state do, there are several: ``m, m/s``.
    """
    found = _UNIT.search(description)
    return found[1] if found else ""


def name_of(key: str, description: str) -> str:
    """What a field is called: the beginning of its description, with its key before a symbol that stands alone.

    Where that is a sentence rather than a name, the key in words.
    """
    name = re.split(r" \(|[;:,]", description)[0].strip()
    if not name or len(name) > LONGEST_NAME or name.split()[0] in _NO_NOUNS or name == key:
        return key.replace("_", " ")
    return f"{key} {name}" if " " not in name else name
