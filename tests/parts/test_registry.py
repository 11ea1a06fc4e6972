"""What parts there are, and what is said of those that cannot be used."""

import math

import numpy as np
import pytest
from pydantic import Field
from pydrake.systems.primitives import ConstantVectorSource, Gain

from drake_formation import ScenarioError, build_diagram, load_scenario, simulate
from drake_formation.analysis import IllPosedError, certify
from drake_formation.config.values import Positive, Section
from drake_formation.lowering.errors import LoweringError
from drake_formation.parts import Part, PartError, find, kinds, part, register, registry
from drake_formation.parts.coordination.consensus import Consensus
from drake_formation.parts.roles import CONTROLLERS, ROLES
from drake_formation.parts.tracking.controller import TrackingController
from drake_formation.scenario import json_schema


@pytest.fixture(autouse=True)
def _as_before():
    """What a test registers is forgotten."""
    registry.find_all()
    known, broken = ({role: dict(its) for role, its in table.items()} for table in (registry._parts, registry._broken))
    yield
    registry._parts.update(known)
    registry._broken.update(broken)
    registry._told()


def silent(role, kind="silent"):
    """A part that may stand for another in its role, and does nothing."""

    @part(role, kind=kind)
    class Silent(Part):
        class Config(Section):
            strength: Positive = Field(default=1.0, description="of nothing (N)")

        def block(self, formation, owner, numbers):
            return ConstantVectorSource([0.0, 0.0])

    return Silent


def test_every_role_has_its_default_and_lists_it_first():
    for name, role in ROLES.items():
        assert next(iter(kinds(name))) == role.default
        assert find(name, role.default).role == name


@pytest.mark.parametrize("role", ROLES)
def test_every_field_of_a_part_says_what_it_means(role):
    for cls in kinds(role).values():
        assert all(field.description for field in cls.Config.model_fields.values())
        assert cls.__doc__


def test_a_registered_part_is_in_the_schema_and_in_messages_until_replaced():
    register(silent("coordination"))
    assert "silent" in str(json_schema())
    with pytest.raises(ScenarioError, match=r"did you mean 'silent'"):
        load_scenario("line", overrides={"consensus.kind": "silnt"})
    with pytest.raises(ScenarioError, match=r"allowed: consensus, .*silent"):
        load_scenario("line", overrides={"consensus.kind": "x"})
    again = register(silent("coordination"))
    assert find("coordination", "silent") is again


def test_a_part_may_not_take_the_name_of_an_installed_one():
    with pytest.raises(PartError, match=r"coordination 'consensus' of drake-formation: drake-formation has a part"):
        register(silent("coordination", "consensus"))


@pytest.mark.parametrize("thing", [object, Section, 5, Part])
def test_what_is_no_part_is_refused(thing):
    with pytest.raises(PartError, match="is no part"):
        register(thing)


def test_a_part_that_does_not_trace_is_named_with_what_brings_it():
    """A law by the math module, which knows floats alone."""

    def rough_force(error, acceleration, numbers):
        return -math.sin(error[0]), -math.sin(error[1])

    @register
    @part("tracking", kind="rough")
    class Rough(Part):
        """Not for symbols."""

        def numbers(self, formation, owner):
            return np.zeros(1), formation.slots[owner]

        def block(self, formation, owner, numbers):
            *groups, slot = numbers
            return TrackingController(rough_force, groups, slot)

    short = {"aggregation.duration": 0.5, "transport.duration": 0.5}
    scenario = load_scenario("line", overrides=short | {"tracking": {"kind": {2: "rough", "default": "lqr"}}})
    with pytest.raises(
        LoweringError, match=r"block 'robot_2/tracking' .* in symbols: .*tracking 'rough' of this session"
    ):
        simulate(scenario, engine="compiled")
    assert simulate(scenario, engine="blocks")["position"].notnull().all()
    with pytest.raises(IllPosedError, match="tracking 'rough' of this session"):
        certify(scenario)


def test_a_role_that_there_is_not_is_refused():
    with pytest.raises(PartError, match=r"no role 'steering'; there are robot, "):
        part("steering", kind="wheel")


def test_an_unknown_part_lists_those_there_are():
    with pytest.raises(PartError, match=r"there is no tracking 'pid'; there are lqr"):
        find("tracking", "pid")


def built(cls):
    register(cls)
    section = ROLES[cls.role].section[0]
    return build_diagram(load_scenario("line", overrides={section: {"kind": cls.kind}}))


@pytest.mark.parametrize("role", CONTROLLERS)
def test_a_block_without_a_port_that_its_role_needs_is_refused_with_its_package(role):
    with pytest.raises(PartError, match=rf"{role} 'silent' of this session: its block has no output port 'force'"):
        built(silent(role))


def test_a_block_that_asks_for_what_nobody_gives_is_refused():
    cls = silent("coordination")
    cls.block = lambda self, formation, owner, numbers: Gain(1.0, 2)
    with pytest.raises(PartError, match=r"coordination 'silent' of this session: .*port"):
        built(cls)


def test_a_kind_of_another_role_is_told_so():
    with pytest.raises(ScenarioError, match=r"tracking\.kind: a kind of avoidance, not of this \(got khatib\)"):
        load_scenario("line", overrides={"tracking.kind": "khatib"})


def test_robots_may_have_consensus_of_their_own():
    scenario = load_scenario("quadrilateral", overrides={"consensus.delta": {"2": 7.0, "default": 1.0}})
    diagram = build_diagram(scenario)
    gains = []
    for i in range(1, 5):
        block = diagram.GetSubsystemByName(f"robot_{i}").GetSubsystemByName("consensus")
        gains.append(block.CreateDefaultContext().get_numeric_parameter(0).CopyToVector()[0])
    assert gains == [1.0, 7.0, 1.0, 1.0]
    assert Consensus.Config(delta=7.0).delta == 7.0
