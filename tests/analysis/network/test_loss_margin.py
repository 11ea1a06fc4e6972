"""Loss margins: known answers, the whole E[Φ ⊗ Φ], and Monte Carlo of the linear loop and of the diagram's blocks."""

import numpy as np
import pytest
from channels import OpenChannels
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eig
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.loss_margin import HIGHEST, LossMargin, loss_margin, stable_losses
from drake_formation.analysis.network.sampled_data import SampledLoop, longest_period, sampled_loop


def formation(name="line", **overrides):
    return linearize(load_scenario(name, overrides={path.replace("__", "."): v for path, v in overrides.items()}))


DAMPED = {"consensus__delta": 1e4, "consensus__delta_v": 600.0}


def second_moment(loop, loss):
    """E[Φ ⊗ Φ] for independent losses, as a polynomial in the arrivals."""
    mean = loop.mean(1 - loss)
    noise = (np.kron(step, step) for step in packets(loop))
    return np.kron(mean, mean) + loss * (1 - loss) * sum(noise)


def packets(loop):
    return [loop.into[place] @ out for place, out in zip(loop.place, loop.out, strict=True)]


def radius(loop, loss):
    return np.abs(np.linalg.eigvals(second_moment(loop, loss))).max()


@pytest.mark.parametrize(("name", "robots"), [("line", 2), ("quadrilateral", 4), ("octagon", 8)])
@pytest.mark.parametrize("share", [0.3, 0.8])
def test_a_held_packet_is_a_late_one(name, robots, share):
    """Undamped virtual springs: T/2 + T p/(1 − p)/N reaches T*/2."""
    loop = formation(name, consensus__delta=1e4)
    margin = loss_margin(loop, period_s=share * longest_period(loop), lost="hold").probability
    assert margin / (1 - margin) == pytest.approx(robots * (1 / share - 1) / 2, rel=2e-3)


@pytest.mark.parametrize("stiffness", [1.45, 3e4])
def test_undamped_virtual_springs_do_not_mind_terms_left_out(stiffness):
    loop = formation("quadrilateral", consensus__delta=1e4, springs__stiffness=stiffness)
    assert loss_margin(loop, period_s=0.9 * longest_period(loop)).probability is None


@pytest.mark.parametrize(("seconds", "delta_v"), [(0.0025, 600.0), (0.005, 600.0), (0.0025, 300.0)])
def test_rare_packets_are_blows_that_the_mean_damping_must_take_up(seconds, delta_v):
    """Two robots as an oscillator whose stiffness is noise: δ T = 2 (d + 2 (1 − p) δ_v)."""
    arrival = (1e4 * seconds / 2 - 9) / (2 * delta_v)
    margin = loss_margin(formation(consensus__delta=1e4, consensus__delta_v=delta_v), period_s=seconds)
    assert 1 - margin.probability == pytest.approx(arrival, rel=0.08)


@given(scenario=scenarios(robots=st.just(2)), share=st.floats(0.1, 0.98), lost=st.just("zero") | st.just("hold"))
@settings(max_examples=15)
def test_the_second_moment_decays_up_to_the_margin_and_no_further(scenario, share, lost):
    loop = linearize(scenario)
    seconds = share * (longest_period(loop) or 1.0)
    margin = loss_margin(loop, period_s=seconds, lost=lost).probability
    sampled = sampled_loop(loop, seconds, lost)
    for loss in np.linspace(0, 0.999, 12) * (margin or HIGHEST):
        assert radius(sampled, loss) < 1 + 1e-12
    if margin is not None:
        assert radius(sampled, margin) == pytest.approx(1, abs=1e-7)
        assert radius(sampled, min(1.0001 * margin, (1 + margin) / 2)) > 1


@pytest.mark.parametrize("share", [0.5, 0.7, 0.95])
@pytest.mark.parametrize("stiffness", [1.45, 3e4])
def test_the_margin_solves_the_eigenvalue_problem_of_the_loss(share, stiffness):
    """Without scanning: of all p at which E[Φ ⊗ Φ], quadratic in p, has the eigenvalue 1, the least in (0, 1)."""
    loop = formation(**DAMPED, springs__stiffness=stiffness)
    seconds = share * longest_period(loop)
    sampled = sampled_loop(loop, seconds)
    third, half = (second_moment(sampled, loss) for loss in (0.0, 0.5))
    one = second_moment(sampled, 1.0)
    square, linear = 2 * (third - 2 * half + one), -3 * third + 4 * half - one
    unit, zero = np.eye(len(one)), np.zeros_like(one)
    losses = eig(
        np.block([[linear, third - unit], [unit, zero]]), np.block([[-square, zero], [zero, unit]]), right=False
    )
    real = losses[np.isfinite(losses) & (np.abs(losses.imag) < 1e-6)].real
    expected = real[(real > 1e-9) & (real < 1)].min()
    assert loss_margin(loop, period_s=seconds).probability == pytest.approx(expected, rel=1e-5)


def test_stability_comes_back_when_next_to_nothing_arrives():
    """Not monotone: the margin is the first loss, and without any packet the local LQR keeps order."""
    loop = formation(**DAMPED)
    seconds = 0.9 * longest_period(loop)
    margin = loss_margin(loop, period_s=seconds).probability
    sampled = sampled_loop(loop, seconds)
    assert radius(sampled, 1.0) < 1
    assert radius(sampled, (1 + margin) / 2) > 1


def case(lost, side):
    """A loop with a margin inside (0, 1), and losses well off it."""
    if lost == "zero":
        loop, seconds = formation(**DAMPED), 0.055
    else:
        loop, seconds = formation(consensus__delta=400.0, tracking__Q=[1.0, 1.0, 400.0, 400.0]), 0.02
    margin = loss_margin(loop, period_s=seconds, lost=lost).probability
    loss = 0.6 * margin if side == "below" else margin + 0.6 * (1 - margin)
    return loop, seconds, loss


def perron(sampled, loss):
    """ρ(E[Φ ⊗ Φ]) and the form P with E[x⁺ᵀ P x⁺] = ρ xᵀ P x: what every sample estimates without bias."""
    moment, size = second_moment(sampled, loss).T, len(sampled.base)
    rate = np.abs(np.linalg.eigvals(moment)).max()
    # The resolvent just above ρ keeps a positive form positive, and leaves Perron's part of it alone.
    form = np.linalg.solve(rate * (1 + 1e-9) * np.eye(size**2) - moment, np.eye(size).ravel()).reshape(size, size)
    np.testing.assert_allclose((moment @ form.ravel()).reshape(size, size), rate * form, atol=1e-5 * np.abs(form).max())
    return rate, (form + form.T) / np.abs(form).max()


@pytest.mark.parametrize("side", ["below", "above"])
@pytest.mark.parametrize("lost", ["zero", "hold"])
def test_monte_carlo_of_the_linear_loop(lost, side):
    loop, seconds, loss = case(lost, side)
    sampled = sampled_loop(loop, seconds, lost)
    rate, form = perron(sampled, loss)
    rng, runs = np.random.default_rng(5), 4000
    state = rng.normal(size=(runs, len(sampled.base)))
    before = np.einsum("rn,nm,rm->r", state, form, state)
    ratios = []
    for _ in range(40):
        arrives = rng.random((runs, len(sampled.place))) >= loss
        packet = np.stack([state @ step.T for step in packets(sampled)], axis=1)
        state = state @ sampled.base.T + (arrives[:, :, None] * packet).sum(axis=1)
        after = np.einsum("rn,nm,rm->r", state, form, state)
        ratios.append(after / before)
        before = after
    check_rate(np.array(ratios), rate, side)


def check_rate(ratios, rate, side):
    """Their mean is ρ, within four standard errors; and it tells on which side of the margin the loss is."""
    error = ratios.std() / np.sqrt(ratios.size)
    assert abs(ratios.mean() - rate) < 4 * error
    assert (rate < 1) == (side == "below")
    if side == "above":
        assert ratios.mean() - 4 * error > 1


@pytest.mark.slow
@pytest.mark.parametrize("side", ["below", "above"])
@pytest.mark.parametrize("lost", ["zero", "hold"])
def test_monte_carlo_of_the_diagrams_blocks(lost, side):
    """The nonlinear robots themselves, brought back near their formation after every period."""
    loop, seconds, loss = case(lost, side)
    sampled = sampled_loop(loop, seconds, lost)
    rate, form = perron(sampled, loss)
    robots, rng = OpenChannels(loop.scenario), np.random.default_rng(7)
    rest = robots.rest.reshape(-1, 4)[robots.of]
    masses = np.array(loop.scenario.robots.mass) * np.ones(loop.robots)

    def whole(state, heard):
        deviation = state - robots.rest
        if lost == "zero":
            return deviation
        last = loop.delta * (heard - rest)[:, :2] + loop.delta_v * (heard - rest)[:, 2:]
        return np.concatenate([deviation, (last / masses[robots.to][:, None]).ravel()])

    ratios = []
    for _ in range(20):
        deviation, late = rng.normal(size=robots.rest.shape), rng.normal(size=rest.shape)
        for _ in range(120):
            small = 1e-5 / np.linalg.norm(deviation)
            state, heard = robots.rest + small * deviation, rest + small * late
            before = whole(state, heard)
            arrives = rng.random(len(robots.to)) >= loss
            state, heard = robots.held_period(state, heard, arrives, lost, seconds)
            after = whole(state, heard)
            ratios.append((after @ form @ after) / (before @ form @ before))
            deviation, late = state - robots.rest, heard - rest
    check_rate(np.array(ratios), rate, side)


@given(growth=st.floats(1.01, 5.0))
def test_the_critical_arrival_probability_of_one_unstable_state(growth):
    """x(k+1) = a x(k) + γ u(k) with u = −a x: arrivals must be likelier than 1 − 1/a² (Schenato et al. 2007)."""
    (stable,) = stable_losses(scalar(growth))
    assert stable == pytest.approx((0.0, 1 / growth**2), rel=1e-9)


def test_the_known_critical_arrival_probability():
    (stable,) = stable_losses(scalar(1.25))
    assert 1 - stable.high == pytest.approx(0.36, abs=5e-7)


def scalar(growth):
    one = np.ones((1, 1, 1))
    return SampledLoop(np.array([[growth]]), one, -growth * one, np.array([0]))


def test_ill_posed_questions_are_refused():
    with pytest.raises(IllPosedError, match=r"unstable even without loss.*periods below 0\.9 ms are stable"):
        loss_margin(formation(consensus__delta=1e4))
    alone = {"shape": "line", "robots": 1, "side": 1.0}
    with pytest.raises(IllPosedError, match="at least two robots"):
        loss_margin(formation(formation=alone, robots__start={"centre": [0.0, 0.0]}))
    with pytest.raises(ValueError, match="above 0"):
        loss_margin(formation(), period_s=0.0)
    with pytest.raises(ValueError, match="zero, hold"):
        loss_margin(formation(consensus__delta=1.0), lost="forget")


def test_without_consensus_nothing_can_be_lost():
    assert loss_margin(formation()).probability is None


def test_it_says_what_it_means_and_gives_plain_values():
    loop = formation(consensus__delta=1e4)
    margin = loss_margin(loop, period_s=4.5e-4, lost="hold")
    assert "with a probability below 0.5" in margin.meaning()
    assert margin.to_dict()["period_s"] == 4.5e-4
    assert type(margin.to_dict()["probability"]) is float
    assert "at any rate" in LossMargin(None, 0.01, "zero", None).meaning()
