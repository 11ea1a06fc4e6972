"""The plate of point masses and springs: stiffness, waves, balance of force and torque, cells."""

import numpy as np
import pytest
from carrying import carried
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import ScenarioError
from drake_formation.lowering.expressions import Graph
from drake_formation.lowering.trace import SymbolTable, TracedBlock
from drake_formation.parts.objects.lattice import Lattice, cells
from drake_formation.parts.objects.plate import PlateMechanics, elongations, spring_forces
from drake_formation.scenario import resolve

seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)
angles = st.floats(-3, 3)


def grid(rows, columns, width=0.5, height=0.4):
    x, y = np.meshgrid(width * np.arange(columns), height * np.arange(rows))
    return np.stack([x, y], axis=-1)


def plate(mass=2.0, k=100.0, c=0.0, diagonal=0.0, width=0.5, height=0.4):
    return [mass, k, c, diagonal, c * diagonal / k, width, height]


def turned(angle, places):
    c, s = np.cos(angle), np.sin(angle)
    return places @ np.array([[c, s], [-s, c]])


def test_stretched_alike_it_has_the_stiffness_of_rows_in_parallel_of_springs_in_series():
    rows, columns, stretch = 3, 5, 0.01
    longer = grid(rows, columns) * [1.0 + stretch, 1.0]
    forces = spring_forces(longer, 0.0 * longer, plate())
    np.testing.assert_allclose(forces[:, 1:-1], 0.0, atol=1e-12)
    elongation = stretch * 0.5 * (columns - 1)
    assert -forces[:, -1, 0].sum() == pytest.approx(100.0 * rows / (columns - 1) * elongation)
    assert forces[:, 0, 0].sum() == pytest.approx(100.0 * rows / (columns - 1) * elongation)
    assert max(elongations(longer, plate())) == pytest.approx(stretch)


def test_sheared_it_is_held_by_its_diagonals_alone():
    rows, columns, shear = 2, 4, 1e-5
    sheared = grid(rows, columns) + grid(rows, columns)[..., ::-1] * [shear, 0.0]
    assert np.abs(spring_forces(sheared, 0.0 * sheared, plate())[..., 0]).max() < 1e-8
    forces = spring_forces(sheared, 0.0 * sheared, plate(diagonal=50.0))
    # Each of two diagonals a cell resists a shear s of the height h with k (w / d)² s, along the way.
    expected = 2 * 50.0 * 0.5**2 / (0.5**2 + 0.4**2) * shear * 0.4 * (columns - 1)
    assert -forces[1, :, 0].sum() == pytest.approx(expected, rel=1e-3)


def test_waves_run_along_a_row_as_in_a_chain_of_masses_and_springs():
    """ω = 2 √(k/m) sin(p π/2n), the free chain's modes; the longest waves run at √(k/m) dx."""
    n, mass, k, width = 40, 2.0, 100.0, 0.5
    rest, step = grid(1, n, width), 1e-6
    columns = []
    for node in range(n):
        moved = rest.copy()
        moved[0, node, 0] += step
        columns.append(spring_forces(moved, 0.0 * moved, plate(mass, k, width=width))[0, :, 0] / mass / step)
    frequencies = np.sqrt(np.abs(np.linalg.eigvalsh(-(np.array(columns) + np.array(columns).T) / 2)))
    modes = np.arange(n)
    np.testing.assert_allclose(np.sort(frequencies), 2 * np.sqrt(k / mass) * np.sin(modes * np.pi / (2 * n)), atol=1e-3)
    wave_number = np.pi / (n * width)
    assert np.sort(frequencies)[1] / wave_number == pytest.approx(np.sqrt(k / mass) * width, rel=1e-3)


@given(seeds)
def test_springs_and_grips_leave_momentum_and_spin_to_the_robots_alone(rng):
    formation = resolve(carried("{kind: lattice, rows: 3, columns: 4, damping: 20}"))
    (part,) = formation.parts["object"]
    mechanics, its = part.mechanics(formation), part.own_numbers(formation)
    state = part.initial_state(formation, 0) + rng.uniform(-0.1, 0.1, 48)
    forces = rng.uniform(-9, 9, (4, 2)).tolist()
    nodes = mechanics.accelerations(state, forces, its).reshape(-1, 2) * part.node_mass
    places, points = state[:24].reshape(-1, 2), np.array(mechanics.points(state, range(4), its))[:, :2]
    np.testing.assert_allclose(nodes.sum(axis=0), np.sum(forces, axis=0), atol=1e-10)
    np.testing.assert_allclose(_moment(places, nodes), _moment(points, np.array(forces)), atol=1e-9)


def test_a_fine_plate_is_no_deep_expression():
    formation = resolve(carried("{kind: lattice, rows: 15, columns: 15}"))
    (part,) = formation.parts["object"]
    block = part.block(formation, 0, part.numbers(formation, 0))
    traced = TracedBlock("object", block, SymbolTable())
    (strain,) = traced.trace(block.GetOutputPort("strain").get_index())
    assert Graph(traced.symbols.leaf_of).read(strain) > 15 * 15


def _moment(places, forces):
    return (places[:, 0] * forces[:, 1] - places[:, 1] * forces[:, 0]).sum()


@given(seeds, angles)
def test_a_turned_plate_feels_turned_forces(rng, angle):
    places, speeds = grid(3, 3) + rng.uniform(-0.1, 0.1, (3, 3, 2)), rng.uniform(-1, 1, (3, 3, 2))
    its = plate(c=5.0, diagonal=30.0)
    expected = turned(angle, spring_forces(places, speeds, its))
    np.testing.assert_allclose(spring_forces(turned(angle, places), turned(angle, speeds), its), expected, atol=1e-9)


@given(seeds)
def test_dampers_take_energy(rng):
    places, speeds = grid(3, 3) + rng.uniform(-0.1, 0.1, (3, 3, 2)), rng.uniform(-1, 1, (3, 3, 2))
    its = plate(c=5.0, diagonal=30.0)
    damped, free = (spring_forces(places, each, its) for each in (speeds, 0.0 * speeds))
    assert ((damped - free) * speeds).sum() <= 1e-12


@given(angles, st.tuples(angles, angles), angles)
def test_the_pose_is_that_of_a_rigid_motion(angle, place, rate):
    mechanics, its = PlateMechanics(3, 4, ()), (np.array(plate()), np.zeros(0))
    rest = grid(3, 4).reshape(-1, 2)
    rest = turned(angle, rest - rest.mean(axis=0))
    speeds = rate * np.stack([-rest[:, 1], rest[:, 0]], axis=-1) + [0.3, -0.2]
    pose = mechanics.pose(np.concatenate([(rest + place).ravel(), speeds.ravel()]), its)
    assert pose == pytest.approx([*place, angle, 0.3, -0.2, rate], abs=1e-9)


@given(seeds, st.integers(2, 5), st.integers(2, 5))
def test_the_weights_of_a_cell_give_the_slot(rng, rows, columns):
    slots = rng.uniform(-3, 3, (6, 2))
    corners, weights = cells(slots, rows, columns)
    low, sides = slots.min(axis=0), np.ptp(slots, axis=0)
    nodes = low + grid(rows, columns, *(sides / [columns - 1, rows - 1])).reshape(-1, 2)
    np.testing.assert_allclose((weights[..., None] * nodes[corners]).sum(axis=1), slots, atol=1e-12)
    assert (weights > -1e-6).all()
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)


@pytest.mark.parametrize("size", [0.1, 0.3, 0.7, 3.0])
def test_a_slot_at_a_node_holds_that_node_whatever_the_size(size):
    slots = size * (grid(4, 4, 1.0, 1.0).reshape(-1, 2) - 1.5)
    corners, weights = cells(slots, 4, 4)
    np.testing.assert_allclose(weights.max(axis=1), 1.0)
    np.testing.assert_array_equal(corners[np.arange(16), weights.argmax(axis=1)], np.arange(16))
    np.testing.assert_array_equal(corners, cells(slots / size, 4, 4)[0])


@pytest.mark.parametrize("kind", ["{kind: lattice}", "{kind: lattice, rows: 2, columns: 7, shear_stiffness: 0}"])
@pytest.mark.parametrize(
    "shape", ["{shape: polygon, robots: 5, side: 1.0}", "{shape: grid, rows: 2, columns: 3, side: 1.0}"]
)
def test_at_rest_nothing_is_strained(kind, shape):
    formation = resolve(carried(kind, formation=shape))
    (part,) = formation.parts["object"]
    mechanics, its, start = part.mechanics(formation), part.own_numbers(formation), part.initial_state(formation, 0)
    robots = range(formation.robots)
    np.testing.assert_allclose(
        np.array(mechanics.points(start, robots, its))[:, :2], formation.slots + formation.centre, atol=1e-12
    )
    np.testing.assert_allclose(mechanics.accelerations(start, [(0.0, 0.0)] * len(robots), its), 0.0, atol=1e-9)
    assert mechanics.strain(start, [], its) == pytest.approx(0.0, abs=1e-12)
    assert part.config.mass == pytest.approx(part.node_mass * part.config.rows * part.config.columns)


def test_robots_in_a_row_hold_a_row_of_nodes():
    line = "{shape: line, robots: 3, side: 1.0, heading: 0}"
    formation = resolve(carried("{kind: lattice, rows: 1, columns: 5}", formation=line))
    corners, weights = cells(formation.slots, 1, 5)
    np.testing.assert_array_equal(corners[np.arange(3), weights.argmax(axis=1)], [0, 2, 4])
    assert isinstance(formation.parts["object"][0], Lattice)


@pytest.mark.parametrize(
    ("fields", "formation", "fault"),
    [
        ("rows: 2", "{shape: line, robots: 3, side: 1.0, heading: 0}", r"object.rows: .*no extent along y \(got 2\)"),
        ("", "{shape: line, robots: 3, side: 1.0}", r"object.columns: the slots have no extent along x"),
        ("rows: 1", None, r"object.rows: one node does not reach over the 2 m of the slots along y"),
        ("rows: 1, columns: 1", "{shape: line, robots: 1, side: 1.0}", r"object: one node is no plate"),
        ("rows: 101", None, r"object.rows: out of range"),
        ("mass: -1", None, r"object.mass: out of range"),
    ],
)
def test_what_it_cannot_be_is_refused_with_the_reason(fields, formation, fault):
    lines = {"formation": formation} if formation else {}
    with pytest.raises(ScenarioError, match=fault):
        carried(f"{{kind: lattice, {fields}}}" if fields else "{kind: lattice}", **lines)
