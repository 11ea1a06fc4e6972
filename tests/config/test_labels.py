import pytest

from drake_formation.config.labels import name_of, unit_of


@pytest.mark.parametrize(
    ("description", "unit"),
    [
        ("mass m_i (kg), one for all", "kg"),
        ("repulsive gain η (N m²)", "N m²"),
        ("k_F (1/(m² s)), slows it", "1/(m² s)"),
        ("step to which what is sent is rounded (m, m/s); 0: none", "m, m/s"),
        ("strain |d/r − 1| (1), longer", "1"),
        ("a cost (Eq. 9) of something", ""),
        ("law (Gilbert 1960) of losses (1)", "1"),
        ("", ""),
    ],
)
def test_the_unit_is_the_first_one_in_parentheses(description, unit):
    assert unit_of(description) == unit


@pytest.mark.parametrize(
    ("key", "description", "name"),
    [
        ("mass", "mass m_i (kg), one for all", "mass m_i"),
        ("stiffness", "k_ij (N/m)", "stiffness k_ij"),
        ("look_every", "how often (s), from then on", "look every"),
        ("margin", "margin (m) by which", "margin"),
        ("x", "a name that is so long that it is a whole sentence and no name (m)", "x"),
        ("seed_of", "", "seed of"),
    ],
)
def test_the_name_is_where_the_description_begins(key, description, name):
    assert name_of(key, description) == name
