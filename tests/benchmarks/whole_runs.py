"""One stiff run by this project's engines and by its peers, at equal accuracy: ``make bench``.

The job is the octagon in steel with δ = 2e4, 60 s from formation. The error is the largest of any robot's position at
every second against a tight reference: the end alone would hide errors, since relative modes decay. Every peer gets the
right-hand side written by hand in numba (diffrax: in JAX; heyoka and CasADi: in their symbols), is called as its users
would, and runs once unmeasured.
"""

import io
import time
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout

import numpy as np
import peers
from formations import IN_FORMATION, STIFF

from drake_formation import build_diagram, load_scenario
from drake_formation.lowering import lower

SECONDS = np.arange(1.0, 61.0)
ACCURACY = 1e-6
REPEATS = 5
SLOW = 3.0
"""What takes longer than this is measured once only (s)."""


class Job:
    """The scenario, compiled and by hand."""

    def __init__(self, offset=0.0, overrides=None):
        self.scenario = load_scenario("octagon", overrides=STIFF | IN_FORMATION | (overrides or {}))
        self.diagram = build_diagram(self.scenario)
        self.compiled = lower(self.diagram)
        rest = self.diagram.CreateDefaultContext().get_continuous_state_vector().CopyToVector()
        off = np.random.default_rng(0).normal(scale=offset, size=(len(rest) // 4, 4)) * [1, 1, 0, 0]
        self.start = rest + off.ravel()
        self.numbers = peers.parameters(self.scenario)
        self.evaluations = 0
        self.reference = self.by("dormand_prince", 1e-12, 0.01)

    def slope(self, _time, x):
        """The right-hand side by hand, as a Python function."""
        self.evaluations += 1
        dx = np.empty(len(x))
        peers.slope(np.ascontiguousarray(x), self.numbers, dx)
        return dx

    def by(self, method, accuracy=ACCURACY, max_step=0.1):
        """States at every second by a method of the compiled diagram."""
        context = self.diagram.CreateDefaultContext()
        context.SetContinuousState(self.start)
        options = {"method": method, "accuracy": accuracy, "max_step": max_step, "at": SECONDS}
        pieces = list(self.compiled.integrate(context, 60.0, **options))
        self.evaluations = sum(piece.evaluations for piece in pieces)
        return np.concatenate([piece.states for piece in pieces])


def by_hand(job):
    states, x = [], job.start
    for _ in SECONDS:  # stopped at every second, in want of dense output
        x, _, evaluations = peers.dormand_prince(x, 1.0, job.numbers, ACCURACY, 0.1)
        job.evaluations += evaluations
        states.append(x)
    return np.array(states)


def by_blocks(job):
    from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig

    simulator = Simulator(job.diagram)
    ApplySimulatorConfig(SimulatorConfig(**job.scenario.simulator.model_dump()), simulator)
    states = []
    for second in SECONDS:
        simulator.AdvanceTo(second)
        states.append(simulator.get_context().get_continuous_state_vector().CopyToVector())
    job.evaluations = simulator.get_integrator().get_num_derivative_evaluations()
    return np.array(states)


def by_scipy(method):
    def run(job):
        from scipy.integrate import solve_ivp

        solution = solve_ivp(
            job.slope, (0.0, 60.0), job.start, method, t_eval=SECONDS, rtol=1e-8, atol=1e-8, max_step=0.1
        )
        return solution.y.T

    return run


def by_control(job):
    import control

    system = control.NonlinearIOSystem(
        lambda t, x, u, params: job.slope(t, x), None, inputs=0, outputs=len(job.start), states=len(job.start)
    )
    response = control.input_output_response(
        system, np.concatenate([[0.0], SECONDS]), 0, job.start, solve_ivp_method="DOP853",
        solve_ivp_kwargs={"rtol": 1e-8, "atol": 1e-8, "max_step": 0.1},
    )  # fmt: skip
    return response.states.T[1:]


def by_bdsim(job):
    import bdsim

    sim = bdsim.BDSim(graphics=False, banner=False, progress=False, quiet=True)
    diagram = sim.blockdiagram()
    state = diagram.INTEGRATOR(x0=job.start, name="state")
    slope = diagram.FUNCTION(lambda x: job.slope(0.0, x), name="slope")
    diagram.connect(state, slope)
    diagram.connect(slope, state)
    diagram.compile(report=False)
    out = sim.run(diagram, T=60.0, dt=1.0, solver="DOP853", solver_args={"rtol": 1e-8, "atol": 1e-8, "max_step": 0.1})
    wanted = [int(np.argmin(np.abs(out.t - second))) for second in SECONDS]
    return np.asarray(out.x)[wanted]


def by_pathsim(job):
    from pathsim import Simulation
    from pathsim.blocks import ODE
    from pathsim.solvers import RKDP54

    block = ODE(lambda x, u, t: job.slope(t, x), job.start)
    simulation = Simulation(
        [block], [], dt=0.01, dt_max=0.1, Solver=RKDP54, log=False, tolerance_lte_abs=ACCURACY, tolerance_lte_rel=0.0
    )
    states = []
    for _ in SECONDS:
        simulation.run(1.0)
        states.append(np.array(block.engine.state, dtype=float))
    return np.array(states)


def by_diffrax(job):
    import diffrax_peer

    if not hasattr(job, "diffrax"):
        job.diffrax = diffrax_peer.one(job.scenario, job.start, 60, ACCURACY)
    return job.diffrax()


def by_symbolic(peer):
    def run(job):
        import symbolic_peers

        if not hasattr(job, peer):
            setattr(job, peer, getattr(symbolic_peers, peer)(job.scenario, job.start, 60))
        return getattr(job, peer)()

    return run


RUNS: dict[str, Callable[[Job], np.ndarray]] = {
    "hand-written Dormand-Prince in numba": by_hand,
    "this diagram, engine `blocks`": by_blocks,
    "this diagram, engine `compiled`": lambda job: job.by("dormand_prince"),
    "this diagram, engine `exponential`": lambda job: job.by("exponential"),
    "this diagram, engine `exponential`, steps to 0.5 s": lambda job: job.by("exponential", max_step=0.5),
    "SciPy DOP853, numba right-hand side": by_scipy("DOP853"),
    "SciPy LSODA, numba right-hand side": by_scipy("LSODA"),
    "python-control, DOP853, numba right-hand side": by_control,
    "bdsim, DOP853, numba right-hand side": by_bdsim,
    "pathsim, RKDP54, numba right-hand side": by_pathsim,
    "diffrax Dopri5, JAX right-hand side": by_diffrax,
    "heyoka, Taylor series, steps to 0.02 s": by_symbolic("heyoka_one"),
    "CasADi, CVODES": by_symbolic("casadi_one"),
}


def measure(run, job):
    """States, least wall time of some runs (s) and derivatives evaluated."""
    spent = []
    for attempt in range(1 + REPEATS):
        job.evaluations = 0
        begin = time.perf_counter()
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            states = run(job)
        if attempt:
            spent.append(time.perf_counter() - begin)
        if spent and spent[-1] > SLOW:
            break
    return states, min(spent), job.evaluations


METHODS = {
    "`compiled`": lambda job: job.by("dormand_prince"),
    "`exponential`": lambda job: job.by("exponential"),
    "`exponential`, steps to 0.5 s": lambda job: job.by("exponential", max_step=0.5),
    "SciPy DOP853": by_scipy("DOP853"),
    "SciPy LSODA": by_scipy("LSODA"),
}
CASES = {
    "rubber, at rest": (0.0, {"springs.stiffness": 1.45}),
    "steel, at rest": (0.0, {}),
    "steel, 1 cm off": (0.01, {}),
    "steel, 5 cm off": (0.05, {}),
}


def compare_methods():
    print("Octagon, δ = 2e4, 60 s: candidates for the integrator, all on numba right-hand sides\n")
    print("| start | by | time (ms) | derivatives | error (m) |\n| --- | --- | --- | --- | --- |")
    for title, case in CASES.items():
        job = Job(*case)
        for name, run in METHODS.items():
            states, spent, evaluations = measure(run, job)
            error = np.abs(states - job.reference).reshape(60, -1, 4)[..., :2].max()
            print(f"| {title} | {name} | {spent * 1e3:.3g} | {evaluations} | {error:.1e} |", flush=True)


def compare(job):
    print("Octagon, steel, δ = 2e4, 60 s from formation, once warm\n")
    print("| by | time (ms) | of hand-written | derivatives | error (m) |\n| --- | --- | --- | --- | --- |")
    by_hand_time = None
    for name, run in RUNS.items():
        try:
            states, spent, evaluations = measure(run, job)
        except ImportError as error:
            print(f"| {name} | not installed ({error.name}) | | | |", flush=True)
            continue
        by_hand_time = by_hand_time or spent
        error = np.abs(states - job.reference).reshape(60, -1, 4)[..., :2].max()
        counted = evaluations or ""
        print(f"| {name} | {spent * 1e3:.3g} | {spent / by_hand_time:.2f} | {counted} | {error:.1e} |", flush=True)


if __name__ == "__main__":
    compare(Job())
    print()
    compare_methods()
