"""Whether collisions are avoided (Sec. 6): clearances of every run, and of robots that meet an obstacle head-on."""

from typing import Any

from drake_formation.paper.readings.two_readings import Reading
from drake_formation.paper.runs import CASES, GAINS, TOPOLOGIES
from drake_formation.paper.store import Store
from drake_formation.paper.verdicts.verdict import Claim, verdict
from drake_formation.scenario import Scenario, resolve, with_overrides

BODY = 0.15
"""A robot that is nearer to a point than this touches it (m); chosen: the paper gives its robots no size."""
PROVED = False
"""Whether the paper proves it: Theorems 1 and 2 leave avoidance out."""
AHEAD = 7.5
BESIDE = 0.04
"""Where an obstacle is put to be met: so far ahead of the front robot's start, and beside its path (m); chosen."""


def avoids_collisions(reading: Reading, store: Store) -> Claim:
    """Sec. 6: stability analysis guarantees collision avoidance."""
    clearances = {label: store.measured(run).min_clearance_m for label, run in _table_runs(reading).items()}
    met = {label: store.measured(run).min_clearance_m for label, run in head_on(reading).items()}
    least, nearest = min(clearances, key=clearances.__getitem__), min(met, key=met.__getitem__)
    return Claim(
        claim="collisions are avoided, guaranteed (Sec. 6)",
        verdict=verdict(min(clearances[least], met[nearest]) > BODY, PROVED),
        evidence=(
            f"in all {len(clearances)} runs robots stay {clearances[least]:.2f} m away and more ({least}). With an "
            f"obstacle {100 * BESIDE:g} cm beside a robot's path it is "
            f"{', '.join(f'{c:.3f} m ({n})' for n, c in met.items())}. The field "
            "grows beyond bounds, so that the robot which feels it as a point never touches a point; no "
            "distance is guaranteed, and none at all to robots that do not feel it; Theorems 1 and 2 leave avoidance "
            f"out. Robots {100 * BODY:g} cm from centre to edge would " + ("collide" if met[nearest] < BODY else "pass")
        ),
        source="all transports and topologies; head-on runs of the quadrilateral with rubber",
    )


def head_on(reading: Reading) -> dict[str, Scenario]:
    """Transports past one obstacle on the path of the front upper robot."""
    runs = {}
    for delta in GAINS[:2]:
        scenario = reading.transport("quadrilateral", "rubber", delta)
        formation = resolve(scenario)
        robot = max(range(formation.robots), key=lambda i: formation.slots[i] @ [1.0, 1.0])
        x, y = formation.centre + formation.slots[robot]
        overrides: dict[str, Any] = {"avoidance.obstacles": [{"position": [float(x) + AHEAD, float(y) + BESIDE]}]}
        if scenario.avoidance.sensing == "assigned":
            overrides["avoidance.assigned"] = [robot + 1]
        runs[f"δ = {delta:g}"] = with_overrides(scenario, overrides)
    return runs


def _table_runs(reading: Reading) -> dict[str, Scenario]:
    transports = {
        f"{name}, {material}, δ = {delta:g}": reading.transport(name, material, delta)
        for name, material, delta in CASES
    }
    return transports | {name: reading.topology(name) for name in TOPOLOGIES}
