"""Whether Drake can simulate with what the scenario asks for."""

from collections.abc import Iterator
from functools import cache

from drake_formation.config.errors import Fault, nearest, shown
from drake_formation.scenario.schema import Scenario


def check(scenario: Scenario) -> Iterator[Fault]:
    """The integration scheme.

    Error control with a scheme that estimates no error is no fault: Drake takes fixed steps then, as documented.
    """
    scheme, schemes = scenario.simulator.integration_scheme, _schemes()
    if scheme not in schemes:
        path, allowed = ("simulator", "integration_scheme"), ", ".join(schemes)
        yield Fault(path, "not one of Drake's integration schemes", shown(scheme), allowed, nearest(scheme, schemes))


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
