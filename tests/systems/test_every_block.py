"""What holds for every block: no false feedthrough, and the same numbers for every scalar type."""

from itertools import chain

import numpy as np
import pytest
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue
from pydrake.symbolic import Evaluate, Expression, Variable

from drake_formation.parts.actuators.motor import Motor
from drake_formation.parts.avoidance.barrier import BarrierFilter
from drake_formation.parts.avoidance.khatib import ObstacleAvoidance
from drake_formation.parts.avoidance.rotational import rotational_force
from drake_formation.parts.computers.sampled import DelayedHold
from drake_formation.parts.coordination.consensus import ConsensusController
from drake_formation.parts.objects.bearing import SpringsBear
from drake_formation.parts.objects.breaking import Breaking
from drake_formation.parts.references.set_point import SetPoint
from drake_formation.parts.robots.omnidirectional import Omnidirectional
from drake_formation.parts.robots.plant import PlanarRobot
from drake_formation.parts.robots.point_mass import RobotPlant, dragged_mass
from drake_formation.parts.robots.unicycle import Unicycle
from drake_formation.parts.sensors.kalman import KalmanSensor
from drake_formation.parts.sensors.noisy import BiasedSensor, NoisySensor
from drake_formation.parts.springs.hookean import Hookean
from drake_formation.parts.springs.linear import Linear
from drake_formation.parts.tracking.controller import TrackingController
from drake_formation.parts.tracking.integral_controller import IntegralController
from drake_formation.parts.tracking.lqr import lqr_force
from drake_formation.systems.consensus_error import ConsensusError
from drake_formation.systems.hand_off import HandOff
from drake_formation.systems.heeding import Heeding
from drake_formation.systems.sensing import NearestSensing
from drake_formation.systems.staged_signals import StagedSignals

SPRINGS = [[10.0, 2.0, 0.5, -1.0], [20.0, 3.0, 1.0, 1.0]]
SHAPES = [1.0, 1.0, 2.0, 1.0, 2.0, 2.0, 1.2, 1.6, 0.1, -1.0, 0.5, -1.0, -0.5, 0.0, 0.0, 9.0, 0.1, 0.2]
OBSTACLES = [[0.5, 0.5, 0.0], [-1.0, 0.5, 0.2], [40.0, 0.0, 0.0]]


def plant(cls, inner_state, **fields):
    """The plant of a robot on wheels."""
    robot = cls(cls.Config(**fields))
    start = [1.0, 2.0, 3.0, 4.0, *inner_state]
    return PlanarRobot(cls.dynamics, [2, 3], Hookean, robot.own_numbers(), SPRINGS, start)


MAKERS = {
    "hookean plant": lambda: RobotPlant([2, 3], Hookean, [40.0], SPRINGS, [1.0, 2.0, 3.0, 4.0]),
    "linear plant": lambda: RobotPlant([2, 3], Linear, [40.0], SPRINGS, [1.0, 2.0, 3.0, 4.0]),
    "plant without springs": lambda: RobotPlant([], Hookean, [40.0], np.zeros((0, 4)), [1.0, 2.0, 3.0, 4.0]),
    "plant with drag": lambda: PlanarRobot(
        dragged_mass, [2, 3], Hookean, [[40.0], [5.0]], SPRINGS, [1.0, 2.0, 3.0, 4.0]
    ),
    "plant that may fail": lambda: RobotPlant(
        [2, 3], Hookean, [40.0], SPRINGS, [1.0, 2.0, 3.0, 4.0], may_fail=True, releases=("intact", "held")
    ),
    "omnidirectional plant": lambda: plant(Omnidirectional, [0.3, -0.1]),
    "omnidirectional plant with limits": lambda: plant(Omnidirectional, [0.3, -0.1], wheel_force_limit=0.2),
    "unicycle plant": lambda: plant(Unicycle, [0.7]),
    "unicycle plant with limits": lambda: plant(Unicycle, [0.7], wheel_force_limit=0.2),
    "tracking": lambda: TrackingController(
        lqr_force, [[[1.0, 0.1, 9.0, 0.2], [0.3, 1.0, 0.4, 9.0]], [0.0]], [0.5, -0.5]
    ),
    "integral tracking": lambda: IntegralController(np.arange(12.0).reshape(2, 6), [40.0], [0.5, -0.5]),
    "integral tracking with anti-windup": lambda: IntegralController(
        np.arange(12.0).reshape(2, 6), [40.0], [0.5, -0.5], [[0.1, 0.2], [0.3, 0.4]]
    ),
    "motors at once": lambda: Motor(("dead_zone", "max_force"), [0.1, 0.3]),
    "slow motors": lambda: Motor(("dead_zone", "max_force", "time_constant", "max_rate"), [0.1, 0.3, 0.2, 0.5]),
    "biased sensor": lambda: BiasedSensor([0.1, 0.2, 0.3, 0.4]),
    "noisy sensor": lambda: NoisySensor(0.1, [0.1, 0.2, 0.3], [0.1, 0.2, 0.3, 0.4], np.ones(4), np.arange(1.0, 11.0)),
    "Kalman filter": lambda: KalmanSensor(0.1, True, [0.1, 40.0, 0.3, 0.4], np.ones(4), [0.0], np.arange(1.0, 5.0)),
    "delayed hold": lambda: DelayedHold(0.1, 0.0, 2),
    "consensus": lambda: ConsensusController([2, 5], [100.0, 7.0], [[1.0, 0.0], [0.0, -1.0]]),
    "consensus without channels": lambda: ConsensusController([], [100.0, 7.0], np.zeros((0, 2))),
    "avoidance": lambda: ObstacleAvoidance([2.0, 30.0], OBSTACLES),
    "masked avoidance": lambda: ObstacleAvoidance([2.0, 30.0], OBSTACLES, masked=True),
    "avoidance without obstacles": lambda: ObstacleAvoidance([2.0, 30.0], np.zeros((0, 3))),
    "rotational avoidance": lambda: ObstacleAvoidance([2.0, 0.8, 0.6, 30.0], OBSTACLES, False, rotational_force),
    "avoidance of shapes": lambda: ObstacleAvoidance(
        [2.0, 30.0], SHAPES, masked=True, footprints=[0.1], layout=((4, 0), (2, 1)), sighted=True
    ),
    "barrier": lambda: BarrierFilter([40.0, 0.3, 2.0, 20.0], OBSTACLES),
    "barrier without obstacles": lambda: BarrierFilter([40.0, 0.3, 2.0, 20.0], np.zeros((0, 3))),
    "sensing": lambda: NearestSensing(3, [[1.0, 1.0, 0.0], [-1.0, 0.5, 0.2]]),
    "sensing without obstacles": lambda: NearestSensing(2, np.zeros((0, 3))),
    "consensus error": lambda: ConsensusError([[0.0, 0.5], [0.5, -0.5], [-0.5, -0.5]]),
    "set point": lambda: SetPoint([2.5, 3.5], [25.0, 3.5]),
    "hand-off": lambda: HandOff(3.0),
    "staged signals": lambda: StagedSignals(1, ["one", "two"], [[[1.0], [2.0]], [[3.0, 4.0], [5.0, 6.0]]]),
    "heeding": lambda: Heeding([0.5, -0.5]),
    "breaking": lambda: Breaking(
        SpringsBear(Hookean, ((0, 1),), False),
        {"state_1": 4, "state_2": 4},
        0.1,
        0.1,
        [SPRINGS[0], [np.inf, 5.0]],
        1,
        {"intact_1": [0]},
    ),
}

SILENT = {
    ("state", "force"), ("state", "phase"), ("state", "spring"), ("spring_force", "force"),
    ("state", "intact"), ("state", "held"), ("state", "failure"), ("spring_force", "failure"),
    ("intact", "state"), ("intact_1", "state"), ("broken_at", "state"),
}  # fmt: skip
"""Outputs and the inputs that do not reach them at once. All others do, in every block."""

REMEMBERED = {
    ("force", "demanded"), ("force", "applied"), ("error", "demanded"), ("error", "applied"),
    ("measured", "true"), ("measured", "demanded"), ("demanded", "asked"),
}  # fmt: skip
"""Likewise of blocks with a state that they change."""


@pytest.fixture(params=MAKERS.values(), ids=MAKERS)
def block(request):
    return request.param()


def inputs(block):
    return [block.get_input_port(i) for i in range(block.num_input_ports())]


def outputs(block):
    return [block.get_output_port(i) for i in range(block.num_output_ports())]


def test_inputs_reach_exactly_the_outputs_that_depend_on_them(block):
    states = block.num_continuous_states() + block.num_discrete_state_groups()
    silent = SILENT | (REMEMBERED if states else set())
    for given in inputs(block):
        for output in outputs(block):
            names = output.get_name(), given.get_name().split("_")[0]
            reached = block.HasDirectFeedthrough(given.get_index(), output.get_index())
            assert reached == (names not in silent), names


def random_inputs(block):
    rng = np.random.default_rng(1)
    return [rng.uniform(0.1, 1, port.size()) for port in inputs(block)]


def evaluated(block, values):
    """All outputs and, of a plant, the derivatives, for given inputs."""
    return all_outputs(block, context_with(block, values))


def context_with(block, values):
    context = block.CreateDefaultContext()
    for port, value in zip(inputs(block), values, strict=True):
        port.FixValue(context, value)
    return context


def all_outputs(block, context):
    results = [port.Eval(context) for port in outputs(block)]
    if context.num_continuous_states():
        results.append(block.EvalTimeDerivatives(context).CopyToVector())
    return np.concatenate([np.ravel(result) for result in results])


def test_changed_parameters_are_felt_at_once(block):
    context, fresh = (context_with(block, random_inputs(block)) for _ in range(2))
    for group in range(context.num_numeric_parameter_groups()):
        all_outputs(block, context)
        for changed in (context, fresh):
            parameter = changed.get_mutable_numeric_parameter(group)
            parameter.SetFromVector(0.1 - 1.5 * parameter.CopyToVector())
        np.testing.assert_array_equal(all_outputs(block, context), all_outputs(block, fresh.Clone()))


def test_automatic_differentiation_gives_the_same_numbers(block):
    values = random_inputs(block)
    differentiated = evaluated(block.ToAutoDiffXd(), [[AutoDiffXd(x) for x in value] for value in values])
    # To the last digit but one: Drake may fuse a product and a sum, and Python does not.
    np.testing.assert_allclose(ExtractValue(differentiated).ravel(), evaluated(block, values), rtol=1e-14, atol=1e-15)


def test_symbols_give_the_same_numbers(block):
    values = random_inputs(block)
    symbols = [[Variable(f"u{i}_{k}") for k in range(len(value))] for i, value in enumerate(values)]
    expressions = evaluated(block.ToSymbolic(), [[Expression(x) for x in symbol] for symbol in symbols])
    numbers = dict(zip(chain(*symbols), np.concatenate([[], *values]), strict=True))
    traced = Evaluate(np.array(expressions, dtype=object).reshape(-1, 1), numbers).ravel() if expressions.size else []
    np.testing.assert_allclose(traced, evaluated(block, values), rtol=1e-12, atol=1e-12)


def test_gradients_are_the_slopes(block):
    values = random_inputs(block)
    flat, step = np.concatenate([[], *values]), 1e-6
    splits = np.cumsum([len(value) for value in values])[:-1]

    def at(point):
        return evaluated(block, np.split(point, splits) if values else [])

    slopes = np.array([(at(flat + row) - at(flat - row)) / (2 * step) for row in step * np.eye(len(flat))])
    variables = np.array([AutoDiffXd(x, row) for x, row in zip(flat, np.eye(len(flat)), strict=True)], dtype=object)
    outcome = evaluated(block.ToAutoDiffXd(), np.split(variables, splits) if values else [])
    gradient = ExtractGradient(outcome.reshape(-1, 1)) if len(flat) else np.zeros((len(outcome), 0))
    gradient = gradient if gradient.size else np.zeros((len(outcome), len(flat)))
    np.testing.assert_allclose(gradient, slopes.T.reshape(gradient.shape), rtol=1e-6, atol=1e-5)
