"""What the minimum bandwidth is, in words and tables; every number comes from a run or from the study that is kept."""

from matplotlib.figure import Figure

from drake_formation.formation.rigidity import rigid_rank
from drake_formation.markdown import markdown_table
from drake_formation.paper.bandwidth.figure import by_channels
from drake_formation.paper.bandwidth.figure_23 import figure_23_measured, figure_23_table, of_the_paper
from drake_formation.paper.bandwidth.findings import Findings, framework
from drake_formation.paper.bandwidth.graphs import ROBOTS, covered
from drake_formation.paper.bandwidth.runs import GAIN, formation, settings
from drake_formation.paper.bandwidth.study import kept
from drake_formation.paper.readings.simulated import SIMULATED, Settings, passes
from drake_formation.paper.store import Store
from drake_formation.scenario import resolve

AS_GOOD = 1.05
"""A graph does as well as the complete one where its error is at most this many times as large; chosen."""


def figure() -> Figure:
    """Error against channels, of every graph of the study."""
    return by_channels(Findings(kept()), ROBOTS)


def answer(store: Store) -> str:
    """The section of the report, in Markdown."""
    measured = figure_23_measured(store)
    found = Findings(kept())
    covers = "\n".join(f"- {robots} robots: {covered(robots)}." for robots in ROBOTS)
    all_graphs = " ".join([of_rigid(found), of_flexible(found), of_displacements(found)])
    return "\n\n".join(
        [
            in_short(),
            of_the_paper(measured),
            figure_23_table(measured),
            f"So it is with all graphs tried. {all_graphs}",
            by_robots_table(found),
            f"{passing()} {of_eight()}",
            f"Tried, each under both laws with rubber and δ = {GAIN:g} N/m, are\n\n{covers}",
            f"The errors of these {2 * len(found.tried)} transports are kept with the package; `drake-formation "
            "reproduce --topologies` runs them again and compares.",
        ]
    )


def in_short() -> str:
    """The answer by itself."""
    few, many = 4, max(ROBOTS)
    return (
        "Where the robots share a direction and compare displacements (Eq. 15), a tree is enough: N − 1 edges, "
        f"{2 * (few - 1)} channels for {few} robots and {2 * (many - 1)} for {many}. Where they compare distances (the "
        "form of Eq. 2), the channels must make the formation rigid: 2N − 3 edges (Laman, 1970), "
        f"{2 * rigid_rank(few)} channels for {few} robots and {2 * rigid_rank(many)} for {many}, instead of "
        f"{few * (few - 1)} and {many * (many - 1)}."
    )


def of_rigid(found: Findings) -> str:
    """What rigid graphs reach."""
    worse = [one for one, ratio in zip(found.rigid, found.ratios(found.rigid), strict=True) if ratio > AS_GOOD]
    best = max(abs(min(found.ratios(found.of(robots).minimally_rigid)) - 1) for robots in ROBOTS)
    stiffness = max(framework(one).softest for one in worse)
    return (
        f"On distances, {len(found.rigid) - len(worse)} of the {len(found.rigid)} rigid ones have at most "
        f"{100 * (AS_GOOD - 1):.0f} % more error than the complete graph of as many robots; the "
        f"best minimally rigid one differs from it by at most {100 * best:.1f} %. The "
        f"other {len(worse)} are rigid, but soft: they resist some change of shape with at most {stiffness:.2g} times "
        "the stiffness δ of a channel, the smallest eigenvalue of RᵀR with R the rigidity matrix, where the complete "
        f"graph of N robots has N/2; they have up to {max(found.ratios(worse)):.2f} times the error."
    )


def of_flexible(found: Findings) -> str:
    """What flexible graphs reach, however many channels they have."""
    ratios = found.ratios(found.flexible)
    largest = max(found.flexible, key=lambda one: (one.channels, one.errors["hookean"]))
    robots = largest.robots
    minimal = max(one.errors["hookean"] for one in found.of(robots).minimally_rigid)
    special = found.ratios(found.only_here_flexible)
    return (
        f"Of the {len(ratios)} flexible ones {sum(ratio <= AS_GOOD for ratio in ratios)} come within "
        f"{100 * (AS_GOOD - 1):.0f} %, where the obstacles happen not to push against what is free; the worst has "
        f"{max(ratios):.1f} times the error. More channels do not help in the wrong place: {robots} robots with "
        f"{largest.channels} of them, one robot hanging on by a single edge, reach {largest.errors['hookean']:.2f} cm, "
        f"the {2 * rigid_rank(robots)} of a minimally rigid graph at most {minimal:.2f} cm. Nor does Laman's count "
        f"alone: {len(special)} of the flexible graphs would be rigid in general position, but not with the robots on "
        f"a circle, and have {min(special):.2f} to {max(special):.2f} times the error."
    )


def of_displacements(found: Findings) -> str:
    """What any connected graph reaches where displacements are compared."""
    worst = max(found.ratios(found.connected, law="linear", best="linear"))
    beside_distances = max(found.ratios(found.connected, law="linear"))
    return (
        f"On displacements, no connected graph has more than {worst:.2f} times the error of the complete one, and none "
        f"more than {100 * beside_distances:.0f} % of what that has on distances, since the rotation is resisted too."
    )


def passing() -> str:
    """Why errors differ with the number of robots."""
    nearest = {robots: float(passes(resolve(formation(robots))).min()) for robots in ROBOTS}
    closest = min(nearest, key=lambda robots: nearest[robots])
    others = min(nearest[robots] for robots in ROBOTS if robots != closest)
    return (
        f"The formations are polygons 1 m across; that of {closest} robots passes an obstacle at "
        f"{nearest[closest]:.2f} m, the others at {others:.2f} m or more, and is pushed most."
    )


def of_eight() -> str:
    """How the eight robots of the study differ from those of the tables."""

    def told(its: Settings) -> str:
        return (
            f"robots {' and '.join(map(str, its.assigned))} feel an obstacle each after {its.duration:g} s of gathering"
        )

    return (
        "As everywhere here, of robots that pass equally near the front one feels the obstacle; of eight robots "
        f"{told(settings(8))}, while in Table 6 as probably simulated {told(SIMULATED['octagon'])}: their errors are "
        "not the same."
    )


def by_robots_table(found: Findings) -> str:
    """Error by number of robots and kind of graph, as a Markdown table."""
    rows = []
    for robots in ROBOTS:
        of = found.of(robots)
        kinds = (of.minimally_rigid, of.braced, of.flexible)
        rows.append(
            [
                f"{robots}",
                f"{2 * (robots - 1)}, {2 * rigid_rank(robots)}, {robots * (robots - 1)}",
                f"{found.alone[robots].errors['hookean']:.2f}",
                *(_range([one.errors["hookean"] for one in kind]) for kind in kinds),
                _range([one.errors["linear"] for one in of.connected]),
            ]
        )
    heading = ["robots", "channels: tree, minimally rigid, complete", "local LQR (cm)"]
    distances = [f"on distances, {kind} (cm)" for kind in ("minimally rigid", "rigid, more than needed", "flexible")]
    return markdown_table([*heading, *distances, "on displacements, connected (cm)"], rows)


def _range(errors: list[float]) -> str:
    """Least and largest, and of how many."""
    return f"{min(errors):.2f} to {max(errors):.2f} ({len(errors)})" if errors else ""
