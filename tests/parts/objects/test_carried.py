"""What holds for every object that is a body of its own: wiring, engines, scalars, results."""

import pickle

import numpy as np
import pytest
from carrying import UNLIKE, carried
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue
from pydrake.symbolic import Evaluate, Expression, Variable

from drake_formation import ScenarioError, build_diagram, load_scenario, metrics, simulate
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.parameters import find_block, set_parameters
from drake_formation.parts import Part, PartError, register, registry
from drake_formation.parts import part as part_of
from drake_formation.parts.objects.rigid import Rigid
from drake_formation.parts.robots.point_mass import PointMass, RobotPlant
from drake_formation.scenario import resolve, to_yaml, with_overrides
from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate

KINDS = ["{kind: rigid, friction: 0.2}", "{kind: lattice, rows: 3, columns: 3}"]
each_kind = pytest.mark.parametrize("kind", KINDS, ids=["rigid", "lattice"])


@pytest.fixture(params=KINDS, ids=["rigid", "lattice"])
def block(request):
    formation = resolve(carried(request.param))
    (part,) = formation.parts["object"]
    return part.block(formation, 0, part.numbers(formation, 0))


@pytest.fixture(autouse=True)
def _as_before():
    """What a test registers is forgotten."""
    known = {role: dict(its) for role, its in registry._parts.items()}
    yield
    registry._parts.update(known)
    registry._told()


def ports(block):
    return (
        [block.get_input_port(k) for k in range(block.num_input_ports())],
        [block.get_output_port(k) for k in range(block.num_output_ports())],
    )


def test_a_grip_force_is_of_its_robot_and_the_phase_and_the_pose_of_none(block):
    inputs, outputs = ports(block)
    for given in inputs:
        for output in outputs:
            name, read = output.get_name(), given.get_name()
            expected = read in ("phase", name.replace("grip_force", "state")) if "grip" in name else name == "strain"
            if (name, read) != ("strain", "phase"):
                assert block.HasDirectFeedthrough(given.get_index(), output.get_index()) == expected, (name, read)


def moving(block, scalar=float, derivative=None):
    """All that a block computes in a state off its rest, with inputs as given."""
    rng = np.random.default_rng(1)
    context = block.CreateDefaultContext()
    state = context.get_continuous_state_vector().CopyToVector()
    values = [rng.uniform(0.1, 0.4, len(state)), *(rng.uniform(1, 3, port.size()) for port in ports(block)[0])]
    flat = np.concatenate(values) if derivative is None else derivative
    offsets = np.split(flat, np.cumsum([len(value) for value in values])[:-1])
    context.SetContinuousState(np.array([x + dx for x, dx in zip(state, offsets[0], strict=True)]))
    for port, value in zip(ports(block)[0], offsets[1:], strict=True):
        port.FixValue(context, value)
    results = [port.Eval(context) for port in ports(block)[1]]
    return flat, np.concatenate([*results, block.EvalTimeDerivatives(context).CopyToVector()])


def test_automatic_differentiation_gives_the_same_numbers_and_their_slopes(block):
    flat, expected = moving(block)
    variables = np.array([AutoDiffXd(x, row) for x, row in zip(flat, np.eye(len(flat)), strict=True)], dtype=object)
    _, found = moving(block.ToAutoDiffXd(), derivative=variables)
    np.testing.assert_allclose(ExtractValue(found).ravel(), expected, rtol=1e-13, atol=1e-13)
    way, step = np.cos(np.arange(len(flat))), 1e-6
    (_, ahead), (_, behind) = (moving(block, derivative=flat + sign * step * way) for sign in (1, -1))
    slope = (ahead - behind) / (2 * step)
    np.testing.assert_allclose(ExtractGradient(found) @ way, slope, rtol=1e-5, atol=1e-3)


def test_symbols_give_the_same_numbers(block):
    flat, expected = moving(block)
    symbols = [Variable(f"x{k}") for k in range(len(flat))]
    _, found = moving(block.ToSymbolic(), derivative=np.array([Expression(x) for x in symbols], dtype=object))
    traced = Evaluate(np.array(found, dtype=object).reshape(-1, 1), dict(zip(symbols, flat, strict=True))).ravel()
    np.testing.assert_allclose(traced, expected, rtol=1e-11, atol=1e-11)


@pytest.mark.slow
@each_kind
def test_all_engines_agree(kind):
    scenario = carried(kind, simulator="{accuracy: 1.0e-9}", **UNLIKE)
    blocks, *others = (simulate(scenario, engine=engine) for engine in ("blocks", "compiled", "exponential"))
    for other in others:
        for name in ("position", "spring_force", "object_pose", "object_strain"):
            np.testing.assert_allclose(other[name].values[-1], blocks[name].values[-1], rtol=1e-5, atol=1e-5)
    assert blocks["object_strain"].max() > 1e-3


@each_kind
@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_the_object_rests_until_the_hand_off_and_its_pose_and_strain_are_in_the_result(kind, engine):
    result = simulate(carried(kind, **UNLIKE), engine=engine)
    assert result["object_pose"].dims == ("time", "pose")
    assert result["object_pose"].attrs["units"] == "m, m, rad, m/s, m/s, rad/s"
    gathering = (result["phase"] == 0).values
    assert 0 < gathering.sum() < len(gathering)
    np.testing.assert_allclose(
        result["object_pose"].values[gathering], [[2.0, 3.0, 0.0, 0.0, 0.0, 0.0]] * gathering.sum(), atol=1e-12
    )
    assert not result["spring_force"].values[gathering].any()
    assert np.abs(result["spring_force"].values[~gathering]).max() > 1.0
    assert result["object_pose"].values[-1, 0] > 2.01
    assert metrics(result).max_spring_strain is None
    speed = np.gradient(result["object_pose"].values[:, 2], result["time"].values)
    np.testing.assert_allclose(speed[~gathering][5:-5], result["object_pose"].values[~gathering][5:-5, 5], atol=0.05)


@each_kind
def test_a_diagram_takes_another_scenarios_numbers(kind):
    changed = {"object.mass": 35.0, "object.grip_stiffness": 5e3, "formation.side": 1.5, "robots.mass": 30.0}
    old, new = carried(kind), with_overrides(carried(kind), changed)
    diagram, expected = build_diagram(old), build_diagram(new)
    context, other = diagram.CreateDefaultContext(), expected.CreateDefaultContext()
    set_parameters(diagram, context, new)
    state = other.get_continuous_state_vector().CopyToVector() + 0.1
    for each in (context, other):
        each.SetTime(1.0)
        each.SetContinuousState(state)
    for it, its in ((diagram, context), (expected, other)):
        find_block(it, "phase").GetMyMutableContextFromRoot(its).SetDiscreteState([1.0])
    np.testing.assert_array_equal(
        diagram.EvalTimeDerivatives(context).CopyToVector(), expected.EvalTimeDerivatives(other).CopyToVector()
    )


def test_a_robot_that_holds_another_cell_of_the_plate_needs_another_diagram():
    def plate(x):
        slots = f"{{shape: slots, slots: [[-1, -1], [1, -1], [{x}, 1], [{-x}, 1]]}}"
        return carried("{kind: lattice, rows: 3, columns: 3}", formation=slots)

    diagram = build_diagram(plate(0.5))
    context = diagram.CreateDefaultContext()
    set_parameters(diagram, context, plate(0.6))
    with pytest.raises(ValueError, match="another structure"):
        set_parameters(diagram, context, plate(-0.5))


@each_kind
def test_a_scenario_is_written_and_read_again(kind):
    scenario = carried(kind)
    assert "springs:" not in to_yaml(scenario)
    assert validate(parse(to_yaml(scenario), "again.yaml")) == scenario
    assert pickle.loads(pickle.dumps(scenario)) == scenario
    again = validate(parse(to_yaml(load_scenario("line")), "line.yaml"))
    assert again == load_scenario("line")


@each_kind
def test_springs_beside_another_object_are_refused_at_their_line(kind):
    with pytest.raises(ScenarioError, match=r"carried.yaml:8.*springs: the carried object is '.*' and has no springs"):
        carried(kind, tracking="{kind: lqr}", springs="{stiffness: 5.0}")
    with pytest.raises(ScenarioError) as caught:
        carried(kind, springs="{stiffness: 5.0}")
    assert len(caught.value.faults) == 1
    same = carried("{kind: springs}", springs="{stiffness: 5.0}")
    assert len(resolve(same).springs.pairs) == 6


@each_kind
def test_another_object_takes_the_place_of_springs_that_are_emptied(kind):
    line = load_scenario("quadrilateral", overrides=["springs={}", f"object={kind}"])
    assert "springs:" not in to_yaml(line)
    assert validate(parse(to_yaml(line), "again.yaml")) == line


@each_kind
def test_it_is_not_certified(kind):
    with pytest.raises(IllPosedError, match=r"the carried object is '(rigid|lattice)'; what is certified are springs"):
        linearize(carried(kind))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["omnidirectional", "unicycle"])
def test_robots_on_wheels_carry_it(kind):
    scenario = carried(KINDS[0], robots=f"{{start: {{centre: [2.0, 3.0]}}, kind: {kind}, heading: 30.0}}")
    blocks, compiled = (simulate(scenario, engine=engine)["position"].values[-1] for engine in ("blocks", "compiled"))
    np.testing.assert_allclose(compiled, blocks, atol=1e-5)


def test_another_packages_object_works_the_same_way():
    @register
    @part_of("object", kind="stone")
    class Stone(Rigid):
        """A rigid body by another name."""

    found, expected = (simulate(carried(f"{{kind: {kind}, mass: 30.0}}"))["position"] for kind in ("stone", "rigid"))
    np.testing.assert_array_equal(found, expected)


def test_an_object_without_a_block_is_refused_with_its_name():
    @register
    @part_of("object", kind="ghost")
    class Ghost(Part):
        """Nothing."""

        def block(self, formation, owner, numbers):
            return None

    with pytest.raises(PartError, match=r"object 'ghost' of this session: it has no block"):
        build_diagram(carried("{kind: ghost}"))


def test_a_plant_that_feels_no_object_is_refused_with_its_name():
    @register
    @part_of("robot", kind="numb")
    class Numb(PointMass):
        """A point mass that knows of springs alone."""

        def block(self, formation, owner, numbers):
            mass, springs = numbers
            return RobotPlant([], formation.law, mass, springs, self.initial_state(formation, owner))

    with pytest.raises(PartError, match=r"robot 'numb' of this session: its block has no input port 'load'"):
        build_diagram(carried(KINDS[0], robots="{start: {centre: [2.0, 3.0]}, kind: numb}"))
