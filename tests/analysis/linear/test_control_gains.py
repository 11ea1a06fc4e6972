"""Control forces differentiated through the diagram: an independent formula, and Drake's own linearization."""

import numpy as np
from hypothesis import given, settings
from pydrake.systems.framework import InputPortSelection
from pydrake.systems.primitives import Linearize
from strategies import scenarios

from drake_formation import build_diagram, load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.control_gains import control_gains
from drake_formation.scenario import resolve


@given(scenario=scenarios())
@settings(max_examples=10, deadline=None)
def test_it_is_what_drake_linearizes_port_by_port(scenario):
    formation = linearize(scenario)
    outputs = control_gains(formation).at(formation.delta, formation.delta_v)
    diagram = build_diagram(formation.scenario)
    for i in range(formation.robots):
        port = diagram.GetOutputPort(f"robot_{i + 1}_control_force").get_index()
        linear = Linearize(diagram, diagram.CreateDefaultContext(), InputPortSelection.kNoInput, port)
        np.testing.assert_allclose(outputs[2 * i : 2 * i + 2], linear.C(), rtol=1e-12, atol=1e-9)


@given(scenario=scenarios())
@settings(max_examples=10, deadline=None)
def test_forces_and_springs_make_the_loop(scenario):
    formation = linearize(scenario)
    outputs = control_gains(formation).at(formation.delta, formation.delta_v)
    drift = np.kron(np.eye(formation.robots), np.eye(4, k=2))
    np.testing.assert_allclose(drift + formation.B @ outputs + formation.springs, formation.A, rtol=1e-9, atol=1e-9)


def test_it_is_the_local_gain_and_the_laplacian():
    formation = linearize(load_scenario("octagon", overrides={"consensus.graph": "cycle"}))
    forces = control_gains(formation)
    local = np.kron(np.eye(8), [[-1, 0, -9, 0], [0, -1, 0, -9]])
    np.testing.assert_allclose(forces.tracking, local, atol=1e-9)
    laplacian = np.kron(formation.laplacian, np.eye(2, 4))
    np.testing.assert_allclose(forces.per_delta, -laplacian, atol=1e-9)
    np.testing.assert_allclose(forces.per_delta_v, -np.roll(laplacian, 2, axis=1), atol=1e-9)


def test_springs_are_no_control():
    steel = load_scenario("quadrilateral", overrides={"springs.stiffness": 3e4})
    stiff, soft = (control_gains(linearize(scenario)).tracking for scenario in (steel, load_scenario("quadrilateral")))
    np.testing.assert_allclose(stiff, soft, atol=1e-12)
    assert resolve(steel).field("spring", "stiffness")[0] == 3e4
