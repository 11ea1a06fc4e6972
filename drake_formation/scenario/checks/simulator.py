"""Whether Drake can simulate with what the scenario asks for."""

from collections.abc import Iterator
from functools import cache

from drake_formation.config.errors import Fault, nearest, shown
from drake_formation.parts.objects.breaking import BOUNDS
from drake_formation.scenario.derive import robot_count
from drake_formation.scenario.schema import Scenario

MOST_STEPS = 1e8
"""More would take weeks and more memory than there is."""

TIGHTEST = 1e-14
"""Positions of some metres are no more exact in double precision (m)."""

LOOSEST = {
    "bogacki_shampine3": 0.1,
    "implicit_euler": 0.5,
    "radau1": 0.5,
    "radau3": 0.01,
    "runge_kutta3": 0.1,
    "runge_kutta5": 1e-3,
    "velocity_implicit_euler": 0.5,
}
"""The schemes that estimate their error, and the accuracy that each of them takes instead of a looser one."""


def check(scenario: Scenario) -> Iterator[Fault]:
    """The integration scheme, its accuracy and its steps.

    Error control with a scheme that estimates no error is no fault: Drake takes fixed steps then, as documented.
    """
    yield from _scheme(scenario)
    yield from _accuracy(scenario)
    yield from _steps(scenario)


def _scheme(scenario: Scenario) -> Iterator[Fault]:
    path, scheme, schemes = ("simulator", "integration_scheme"), scenario.simulator.integration_scheme, _schemes()
    if scheme not in schemes:
        allowed = ", ".join(schemes)
        yield Fault(path, "not one of Drake's integration schemes", shown(scheme), allowed, nearest(scheme, schemes))
    elif scheme == "velocity_implicit_euler" and robot_count(scenario.formation) > 1:
        allowed = ", ".join(name for name in schemes if name != scheme)
        message = "Drake mixes up the positions and velocities of several blocks in it; it is right for one robot alone"
        yield Fault(path, message, shown(scheme), allowed)


def _accuracy(scenario: Scenario) -> Iterator[Fault]:
    settings = scenario.simulator
    loosest = LOOSEST.get(settings.integration_scheme)
    if loosest is None or not settings.use_error_control:
        return
    path, value, allowed = ("simulator", "accuracy"), shown(settings.accuracy), f"{TIGHTEST:g} to {loosest:g}"
    if settings.accuracy > loosest:
        yield Fault(path, f"looser than {settings.integration_scheme} goes", value, allowed)
    if settings.accuracy < TIGHTEST:
        yield Fault(path, "tighter than double precision goes", value, allowed)


def _steps(scenario: Scenario) -> Iterator[Fault]:
    longest, duration = scenario.simulator.max_step_size, scenario.aggregation.duration + scenario.transport.duration
    if duration > MOST_STEPS * longest:
        message = f"{duration / longest:.2g} steps and more are too many for {duration:g} s"
        yield Fault(("simulator", "max_step_size"), message, shown(longest), f"at least {duration / MOST_STEPS:g} s")
    looks, carried = getattr(scenario.object, "look_every", None), scenario.transport.duration
    springs = [getattr(scenario.springs, name, None) for name in BOUNDS]
    bounds = [getattr(scenario.object, "grip_strength", None), *springs]
    if looks and any(bound is not None for bound in bounds) and carried > MOST_STEPS * looks:
        message = f"{carried / looks:.2g} looks are too many for {carried:g} s"
        yield Fault(("object", "look_every"), message, shown(looks), f"at least {carried / MOST_STEPS:g} s")


@cache
def _schemes() -> list[str]:
    """Drake's schemes, without those that integrate only a MultibodyPlant."""
    from pydrake.systems.analysis import GetIntegrationSchemes, ResetIntegratorFromFlags, Simulator
    from pydrake.systems.framework import DiagramBuilder
    from pydrake.systems.primitives import Integrator

    builder = DiagramBuilder()
    plant = builder.AddNamedSystem("plant", Integrator(1))
    builder.ExportInput(plant.get_input_port())
    simulator = Simulator(builder.Build())
    schemes = []
    for scheme in GetIntegrationSchemes():
        try:
            ResetIntegratorFromFlags(simulator, scheme, 0.1)
        except RuntimeError:
            continue
        schemes.append(scheme)
    return schemes
