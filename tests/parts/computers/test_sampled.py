"""Control forces worked out at times: against the sampled system worked out by hand."""

import numpy as np
import pytest
from tracking_loops import START, alone, two

from drake_formation import ScenarioError, build_diagram, simulate, with_overrides
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.measuring import metrics
from drake_formation.parts.tracking.lqr import lqr_gain
from drake_formation.parts.tracking.lqr_discrete import sampled_matrices

MASS = 40.0


def sampled(scenario, **computer):
    """The scenario with computers that look at times."""
    return with_overrides(scenario, {"computer": {"kind": "sampled", **computer}})


def by_hand(period, delay, samples):
    """States (m, m/s) of the robot at its samples, and the forces (N) asked for at them; none before the first."""
    gain, state = lqr_gain(MASS, np.eye(4), np.eye(2)), np.array([*START, 0.0, 0.0])
    behind, rest = divmod(round(delay / period * 1e6), 10**6)
    rest *= period / 1e6
    states, forces = [state], [np.zeros(2)] * (behind + 1)
    for _ in range(samples):
        forces.append(-gain @ state)
        for span, force in ((rest, forces[-2 - behind]), (period - rest, forces[-1 - behind])):
            if span > 0.0:
                a, b = sampled_matrices(MASS, span)
                state = a @ state + b @ force
        states.append(state)
    return np.array(states), np.array(forces[behind + 1 :])


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
@pytest.mark.parametrize("delay", [0.0, 0.03, 0.1, 0.23])
def test_the_robot_moves_as_the_sampled_system_with_its_delay(engine, delay):
    result = simulate(sampled(alone(duration=2.0), period=0.1, delay=delay), engine=engine)
    expected, _ = by_hand(0.1, delay, 20)
    found = result.sel(time=0.1 * np.arange(21), method="nearest")
    np.testing.assert_allclose(found["position"].values[:, 0], expected[:, :2], atol=1e-9)
    np.testing.assert_allclose(found["velocity"].values[:, 0], expected[:, 2:], atol=1e-9)


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_metrics_take_the_force_as_it_is_held(engine):
    scenario = sampled(alone(duration=2.0), period=0.1)
    states, forces = by_hand(0.1, 0.0, 20)
    found = metrics(simulate(scenario, engine=engine))
    assert found["rms_force_n"] == pytest.approx(np.sqrt((forces**2).sum(axis=1).mean()), rel=1e-9)
    assert found["peak_force_n"] == pytest.approx(np.linalg.norm(forces, axis=1).max(), rel=1e-9)
    # Forces are constant from sample to sample and the robot does not turn back, so work is force times way.
    work = np.abs((forces * np.diff(states[:, :2], axis=0)).sum(axis=1)).sum()
    assert found["energy_j"] == pytest.approx(work, rel=1e-6)


def test_a_phase_lets_the_first_force_wait():
    result = simulate(sampled(alone(duration=0.5), period=0.2, phase=0.07))
    waiting = result["time"].values <= 0.07
    assert waiting.sum() > 1
    assert not result["control_force"].values[waiting].any()
    assert result["control_force"].values[~waiting].all()


def test_robots_may_have_periods_of_their_own():
    result = simulate(sampled(two(duration=1.0), period=[0.2, 0.05]))
    values = [len(np.unique(result["control_force"].values[:, robot, 0])) for robot in (0, 1)]
    assert values == [5, 20]
    assert "demanded_force" in result


def test_a_continuous_computer_is_no_block():
    robot = build_diagram(two()).GetSubsystemByName("robot_1")
    assert not any(robot.HasSubsystemNamed(name) for name in ("computer", "sensor", "actuator"))


def test_the_analysis_refuses_it_by_name():
    with pytest.raises(IllPosedError, match="robot 1 has computer 'sampled' of drake-formation"):
        linearize(sampled(two()))


@pytest.mark.parametrize(
    ("computer", "message"),
    [
        ({"period": 0.0}, r"computer.period: out of range \(got 0.0"),
        ({"delay": -0.1}, r"computer.delay: out of range \(got -0.1"),
        ({"phase": 0.01}, r"computer.phase: not within a period \(got 0.01\); allowed: below period = 0.01 s"),
        ({"delay": 20.0}, r"computer.delay: more than 1000 samples would be on their way"),
    ],
)
def test_bad_timing_is_refused_with_the_place(computer, message):
    with pytest.raises(ScenarioError, match=message):
        sampled(two(), **computer)
