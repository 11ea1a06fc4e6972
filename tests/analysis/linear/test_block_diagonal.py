"""Blocks have the spectra of the whole, and are as small as structure allows."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.block_diagonal import blocks
from drake_formation.scenario import resolve


@given(scenario=scenarios(robots=st.integers(1, 4)), z=st.complex_numbers(max_magnitude=2, allow_subnormal=False))
@settings(max_examples=20)
def test_every_combination_keeps_its_eigenvalues(scenario, z):
    formation = linearize(scenario)
    present, delayed = formation.tracking + formation.springs, formation.consensus(formation.delta, formation.delta_v)
    parts = blocks([present, delayed], resolve(formation.scenario).masses)
    assert sum(len(part[0]) for part in parts) == len(present)
    whole = np.poly(np.linalg.eigvals((present + z * delayed) / np.abs(present).max()))
    apart = np.poly(np.concatenate([np.linalg.eigvals((a + z * b) / np.abs(present).max()) for a, b in parts]))
    np.testing.assert_allclose(apart, whole, rtol=1e-7, atol=1e-7 * np.abs(whole).max())


@given(scenario=scenarios(robots=st.integers(1, 4)))
@settings(max_examples=10)
def test_products_are_the_blocks_products(scenario):
    formation = linearize(scenario)
    present, delayed = formation.tracking + formation.springs, formation.consensus(formation.delta, formation.delta_v)
    parts = blocks([present, delayed], resolve(formation.scenario).masses)
    assert sum(np.trace(a @ b @ a) for a, b in parts) == pytest.approx(
        np.trace(present @ delayed @ present), rel=1e-9, abs=1e-6
    )


@pytest.mark.parametrize("name", ["line", "quadrilateral", "octagon"])
def test_the_papers_formations_fall_into_single_modes(name):
    formation = linearize(load_scenario(name, overrides={"consensus.delta": 1e4, "springs.stiffness": 3e4}))
    consensus = formation.consensus(1e4, 10.0)
    parts = blocks([formation.tracking + formation.springs, consensus], resolve(formation.scenario).masses)
    assert {part[0].shape for part in parts} == {(2, 2)}
