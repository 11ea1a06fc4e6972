"""What the block diagram costs, beside the same diagram of naively written blocks: ``make bench``.

Ratios within one run are meant; the absolute times are of the machine it ran on.
"""

import statistics
import time

import numpy as np
from formations import IN_FORMATION, STIFF
from independent import solve
from naive import naive_diagram
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig

from drake_formation import build_diagram, load_scenario, simulate


def derivative_cost(diagram, evaluations=300):
    """Processor time of one derivative of the whole diagram (µs)."""
    context = diagram.CreateDefaultContext()
    begin = time.process_time()
    for k in range(evaluations):
        context.SetTime(1e-9 * (k + 1))
        diagram.EvalTimeDerivatives(context)
    return (time.process_time() - begin) / evaluations * 1e6


def run(diagram, scenario, times):
    """States at the given times, wall time (s) and derivative evaluations of one run on Drake's Simulator."""
    simulator = Simulator(diagram)
    ApplySimulatorConfig(SimulatorConfig(**scenario.simulator.model_dump()), simulator)
    simulator.Initialize()
    states = []
    begin = time.perf_counter()
    for moment in times:
        simulator.AdvanceTo(moment)
        states.append(simulator.get_context().get_continuous_state_vector().CopyToVector().reshape(-1, 4))
    wall = time.perf_counter() - begin
    return np.array(states), wall, simulator.get_integrator().get_num_derivative_evaluations()


def compare_derivatives():
    print("Processor time of one derivative of the whole diagram, median of 9 (µs)\n")
    print("| scenario | robots | naive blocks | these blocks | ratio |\n| --- | --- | --- | --- | --- |")
    for name in ("line", "quadrilateral", "octagon"):
        scenario = load_scenario(name, overrides={**STIFF, **IN_FORMATION})
        pair = naive_diagram(scenario), build_diagram(scenario)
        costs = np.array([[derivative_cost(diagram) for diagram in pair] for _ in range(9)])
        slow, quick = np.median(costs, axis=0)
        ratio = statistics.median(costs[:, 0] / costs[:, 1])
        robots = pair[1].num_continuous_states() // 4
        print(f"| {name} | {robots} | {slow:.0f} | {quick:.0f} | {ratio:.1f} |", flush=True)


def compare_runs():
    print("\nWhole runs of 60 s of transport from formation at the default accuracy\n")
    print("| run | blocks | time (s) | derivatives | error (m) |\n| --- | --- | --- | --- | --- |")
    times = np.arange(0.0, 61.0)
    for title, name, overrides in (
        ("line, rubber, δ = 0", "line", {}),
        ("octagon, steel, δ = 2e4", "octagon", STIFF),
    ):
        scenario = load_scenario(name, overrides={**overrides, **IN_FORMATION})
        exact = solve(scenario, times)
        for blocks, build in (("these", build_diagram), ("naive", naive_diagram)):
            states, wall, evaluations = run(build(scenario), scenario, times)
            error = np.abs(states - exact)[..., :2].max()
            print(f"| {title} | {blocks} | {wall:.2f} | {evaluations} | {error:.1e} |", flush=True)


def time_simulate():
    begin = time.perf_counter()
    simulate(load_scenario("line"))
    wall = time.perf_counter() - begin
    print(f"\n`simulate(load_scenario('line'))`, 60 s of aggregation and 60 s of transport, twice: {wall:.2f} s")


if __name__ == "__main__":
    compare_derivatives()
    compare_runs()
    time_simulate()
