"""Text for any terminal, and commands that end in good order."""

import string
import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.terminal import Stopped, console, orderly, stop

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


@given(st.text(string.ascii_letters + string.punctuation + " δ"))
def test_tables_take_texts_as_they_are(text):
    assert console().render_str(text).plain == text


def test_a_message_is_all_that_is_said(capsys):
    with pytest.raises(SystemExit) as end:
        stop("why", 7)
    assert end.value.code == 7
    assert capsys.readouterr() == ("", "why\n")


def test_being_stopped_is_a_message_and_a_status(capsys):
    with pytest.raises(SystemExit) as end, orderly():
        raise Stopped("terminated", 143)
    assert end.value.code == 143
    assert capsys.readouterr() == ("", "terminated\n")


def test_every_letter_of_greek_has_a_name():
    greek = [chr(code) for code in range(0x391, 0x3CA) if unicodedata.name(chr(code), "")]
    assert all(letter.encode("ascii", "transliterate").decode().isalpha() for letter in greek)
