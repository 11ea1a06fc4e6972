"""What a terminal cannot show is spelt out."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

import drake_formation.terminal.letters  # noqa: F401 (registers what is tried here)

PRINTED = {
    "δ = 5 N/m": "delta = 5 N/m",
    "η ≤ ζ": "eta <= zeta",
    "Ω": "Omega",
    "√2": "sqrt2",
    "m²": "m^2",
    "N·s": "N.s",
    "1 × 2": "1 x 2",
    "日": "\\u65e5",
    "\udcff": "\\udcff",
    "\N{GREEK SMALL LETTER ALPHA WITH TONOS}": "alpha",
    "┃ ━": "| -",
}


@pytest.mark.parametrize("text", PRINTED)
def test_what_ascii_lacks_is_spelt_out(text):
    assert text.encode("ascii", "transliterate").decode() == PRINTED[text]


@given(st.characters())
@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "utf-8"])
def test_every_character_can_be_printed_in_every_encoding(encoding, character):
    assert character.encode(encoding, "transliterate")


def test_what_an_encoding_has_stays_as_it_is():
    assert "m² à δ".encode("latin-1", "transliterate") == "m² à delta".encode("latin-1")


def test_every_letter_of_greek_has_a_name():
    greek = [chr(code) for code in range(0x391, 0x3CA) if unicodedata.name(chr(code), "")]
    assert all(letter.encode("ascii", "transliterate").decode().isalpha() for letter in greek)
