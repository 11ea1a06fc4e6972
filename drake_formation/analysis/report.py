"""A certificate for the terminal: the verdict, what it rests on, and what the numbers mean."""

from collections.abc import Callable, Iterator

import numpy as np
from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from drake_formation.analysis.certificate import Certificate
from drake_formation.analysis.linear.motion_subspaces import PARTS
from drake_formation.analysis.stability.local_lqr import GUARANTEED_GAIN, GUARANTEED_PHASE_DEG
from drake_formation.analysis.stability.modes import Mode
from drake_formation.terminal.tables import heading

MOST_ROWS = 16
"""Longer tables of modes are summed up by kind; the certificate has them all."""


def report(certificate: Certificate) -> RenderableType:
    """A certificate as something rich can print."""
    blocks: list[RenderableType] = []
    for title, block in _BLOCKS.items():
        content = list(block(certificate))
        if content:
            blocks += ["", heading(title), *(Padding(part, (0, 0, 0, 2), expand=False) for part in content)]
    name = Text(f"{certificate.scenario.name}: certificate of the formation at rest", style="bold")
    return Group(name, *blocks)


def _verdict(certificate: Certificate) -> Iterator[RenderableType]:
    if certificate.channels is not None:
        label, reason = certificate.channels.label, certificate.channels.reason
        style = {"stable": "bold green", "unstable": "bold red"}.get(label, "bold yellow")
        yield Text.assemble((f"over its channels: {label}. ", style), f"{reason[0].upper()}{reason[1:]}.")
    yield from _verdict_over_wires(certificate)
    if certificate.channels is not None:
        yield Text("All that follows is for the same formation with wires for channels.")


def _verdict_over_wires(certificate: Certificate) -> Iterator[RenderableType]:
    modes, over = certificate.modes, "" if certificate.channels is None else "over wires, "
    if modes.stable:
        slowest = modes.slowest
        kinds = ", ".join(dict.fromkeys(mode.kind for mode in slowest))
        yield Text.assemble(
            (f"{over}stable: yes. ", "bold green"),
            f"Every small deviation dies out. The slowest motion ({kinds}) decays at {_number(slowest[0].decay_rate)} "
            f"1/s and stays below 2 % of its beginning after {_number(slowest[0].settling_time)} s.",
        )
        return
    if modes.stable is None:
        yield Text.assemble(
            (f"{over}stable: cannot be told. ", "bold yellow"),
            "A motion decays or grows so slowly beside the fastest one that rounding hides which. The numbers of the "
            "scenario are too far apart in size: look at springs.stiffness, consensus.delta and consensus.delta_v.",
        )
        return
    fastest = sorted(modes.unstable, key=lambda mode: mode.decay_rate)
    grown = "; ".join(f"{mode.kind} grows at {_number(-mode.decay_rate)} 1/s, {_pace(mode)}" for mode in fastest[:3])
    more = f"; and {len(fastest) - 3} more" if len(fastest) > 3 else ""
    yield Text.assemble((f"{over}stable: no. ", "bold red"), f"Any disturbance grows: {grown}{more}.")
    yield Text(f"Why: {certificate.cause}.")
    for remedy in certificate.remedies:
        yield Text(f"Try {remedy}.")
    if not certificate.remedies:
        yield Text("No δ_v up to 1e6 N s/m helps; look at tracking.Q, tracking.R and springs.damping.")


def _local(certificate: Certificate) -> Iterator[RenderableType]:
    loops = certificate.sections.get("local")
    if loops is None:
        return
    table = _table("robots", "mass (kg)", "decay (1/s)", "V certifies (1/s)", "gain margin", "phase margin", "Riccati")
    for loop in loops:
        margins = loop.margins
        table.add_row(
            _robots(loop.robots),
            _number(loop.mass),
            _number(loop.decay_rate),
            _number(loop.certified_decay_rate),
            f"({_number(margins.lowest_gain)}, {_number(margins.highest_gain, 'inf')})",
            "any" if margins.phase_deg is None else f"{margins.phase_deg:.1f}°",
            f"{loop.riccati_residual:.0e}",
        )
    yield table
    independent = all(loop.margins.independent for loop in loops)
    yield Text(
        "V = x'Px falls along every motion as -x'(Q + K'RK)x (eigenvalue check), so each robot alone is stable. Every "
        f"LQR is guaranteed a gain margin of ({GUARANTEED_GAIN:g}, inf) and a phase margin of "
        f"{GUARANTEED_PHASE_DEG:g}° at the plant's input, in "
        f"{'x and y independently' if independent else 'x and y alike'}; the table has the actual ones, without the "
        "other robots."
    )


def _modes(certificate: Certificate) -> Iterator[RenderableType]:
    modes = certificate.modes.modes
    table = _table("motion", "count", "λ", "decay (1/s)", "frequency (rad/s)", "damping ratio", "settles (s)")
    groups = [(mode,) for mode in modes] if len(modes) <= MOST_ROWS else _by_kind(modes)
    for group in groups:
        times = [mode.settling_time for mode in group]
        table.add_row(
            _shares(group[0]) if len(group) == 1 else f"{group[0].kind}, {len(group)} modes",
            str(sum(mode.count for mode in group)),
            _range([mode.laplacian_eigenvalue for mode in group]),
            _range([mode.decay_rate for mode in group]),
            _range([mode.frequency for mode in group]),
            _range([mode.damping_ratio for mode in group]),
            "never" if None in times else _range([time for time in times if time is not None]),
        )
    yield table
    yield Text(
        "centre: all robots together; rotation: as a rigid body; stretch: what the object's springs resist; consensus: "
        "changes of shape that it does not. λ is the eigenvalue of the communication graph's Laplacian."
    )
    fixed = sorted({mode.kind for mode in modes if not mode.moved_by_consensus})
    if fixed:
        yield Text(f"Consensus cannot move: {', '.join(fixed)}.")
    limit = certificate.modes.decay_limit
    if limit is not None:
        delta_v = certificate.formation.delta_v
        yield Text(
            f"What it moves decays at {_number(limit)} 1/s on average whatever δ is (δ_v = {delta_v:g} N s/m): δ makes "
            "motions faster, not shorter. δ_v makes them shorter."
        )


def _object(certificate: Certificate) -> Iterator[RenderableType]:
    springs = certificate.sections.get("springs")
    if springs is None:
        return
    if springs.law == "linear":
        yield Text(
            f"The paper's linear law (5): it also resists a rotation, with {_number(springs.linear_rotation)} N/m. "
            "Springs that act along their line only leave the rotation free, and here "
            f"{springs.mechanisms or 'no'} changes of shape."
        )
        return
    shape = "hold the shape" if springs.rigid else f"leave {springs.mechanisms} changes of shape free"
    yield Text(
        f"Springs: {springs.springs}, of rigidity rank {springs.rank}. They {shape}, and leave the rotation to "
        "consensus and the local LQR, however stiff they are; the paper's linearization (5) would resist it with "
        f"{_number(springs.linear_rotation)} N/m."
    )


def _rigidity(certificate: Certificate) -> Iterator[RenderableType]:
    shape = certificate.sections.get("rigidity")
    if shape is None or certificate.formation.robots < 2:
        return
    yield from map(Text, shape.meaning())


def _smallest_delta(certificate: Certificate) -> Iterator[RenderableType]:
    found = certificate.sections.get("smallest_delta")
    if found is None:
        return
    wanted = [f"damping ratio {found.damping_ratio:g}"] if found.damping_ratio is not None else []
    wanted += [f"decay rate {found.decay_rate:g} 1/s"] if found.decay_rate is not None else []
    answer = found.reason if found.delta is None else f"δ = {_number(found.delta)} N/m ({found.reason})"
    yield Text(f"For a {' and a '.join(wanted)}: {answer}.")


def _communication(certificate: Certificate) -> Iterator[RenderableType]:
    for name in ("delay_neighbour", "delay_relative", "loss"):
        section = certificate.sections.get(name)
        if section is not None:
            meaning = section.meaning()
            yield Text(f"{meaning[0].upper()}{meaning[1:]}.")
    loss = certificate.sections.get("loss")
    if loss is not None and loss.longest_period_s is not None:
        yield Text(f"Without loss the loop tolerates sampling periods below {_number(1e3 * loss.longest_period_s)} ms.")


def _disturbance(certificate: Certificate) -> Iterator[RenderableType]:
    section = certificate.sections.get("disturbance")
    if section is None:
        return
    worst = section.to_dict()
    table = _table("what acts", "consensus error", "unit")
    table.add_row("a blow on any one robot, at most", _number(worst["pulse_error_m_per_ns"]), "m per N s")
    table.add_row(
        f"a sinusoidal force on one robot, worst at {_number(worst['hinf_frequency_rad_per_s'])} rad/s",
        _number(worst["hinf_m_per_n"]),
        "m per N",
    )
    table.add_row("white force noise on every robot, RMS", _number(worst["rms_m_per_n_per_sqrt_hz"]), "m per N/√Hz")
    table.add_row(
        "noise in communicated positions, RMS", _number(worst["rms_m_per_m_per_sqrt_hz_position"]), "m per m/√Hz"
    )
    yield table


def _design(certificate: Certificate) -> Iterator[RenderableType]:
    advice = certificate.sections.get("design")
    if advice is None:
        return
    velocity, tuned, limited = advice.velocity, advice.tuned, advice.force_limited
    if velocity is not None:
        yield Text(
            f"consensus.delta_v = {_number(velocity.delta_v)} N s/m gives the slowest consensus mode a damping ratio "
            f"of {_number(velocity.damping_ratio)} (without: {_number(velocity.without)})."
        )
    if tuned is not None:
        yield Text(
            f"Tuned against effort: δ = {_number(tuned.delta)} N/m, δ_v = {_number(tuned.delta_v)} N s/m; error "
            f"{_number(tuned.error)} m² s (now {_number(advice.present_error)}), effort {_number(tuned.effort)} N² s "
            f"(now {_number(advice.present_effort)}), for hand-off errors of {100 * advice.hand_off_error_m:g} cm."
        )
    if limited is not None:
        yield Text(f"Largest δ under {limited.force_limit_n:g} N: {_number(limited.delta)} N/m.")
    if "force_limited" in advice.unanswered:
        yield Text(f"Largest δ under the force limit: none, {advice.unanswered['force_limited']}.")


def _topology(certificate: Certificate) -> Iterator[RenderableType]:
    found = certificate.sections.get("topology")
    if found is None:
        return
    edges = " ".join(f"{i}-{j}" for i, j in found.graph.edges)
    yield Text(
        f"{found.graph.channels} channels ({edges}) keep the error at {_number(found.graph.error_m)} m, under the "
        f"{_number(found.error_bound_m)} m asked for; no connected graph with fewer than {found.least_channels} does "
        f"({found.proof}). Error: {found.measure}."
    )


def _unanswered(certificate: Certificate) -> Iterator[RenderableType]:
    for name, reason in certificate.unanswered.items():
        yield Text(f"{_LABELS.get(name, name)}: {reason}")


def _not_covered(certificate: Certificate) -> Iterator[RenderableType]:
    yield from (Text(f"- {line}") for line in certificate.not_covered)


_BLOCKS: dict[str, Callable[[Certificate], Iterator[RenderableType]]] = {
    "Verdict": _verdict,
    "Local loop (Theorem 1)": _local,
    "Modes of the formation (Theorem 2)": _modes,
    "Carried object": _object,
    "Rigidity": _rigidity,
    "Smallest δ": _smallest_delta,
    "Communication": _communication,
    "Disturbances": _disturbance,
    "Suggestions": _design,
    "Fewest channels": _topology,
    "No answer": _unanswered,
    "Not covered": _not_covered,
}

_LABELS = {
    "channels": "channels",
    "local": "local loop",
    "springs": "carried object",
    "smallest_delta": "smallest δ",
    "delay_neighbour": "delay of neighbours' states",
    "delay_relative": "delay of relative states",
    "loss": "lost packets",
    "disturbance": "disturbances",
    "design": "suggestions",
    "topology": "fewest channels",
}


def _table(*columns: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="dim")
    for k, column in enumerate(columns):
        table.add_column(column, justify="left" if k == 0 else "right")
    return table


def _by_kind(modes: tuple[Mode, ...]) -> list[tuple[Mode, ...]]:
    groups = [tuple(mode for mode in modes if mode.kind == kind) for kind in PARTS]
    return [group for group in groups if group]


def _shares(mode: Mode) -> str:
    """The parts that make up at least a twentieth of a mode, the largest first."""
    large = [part for part in PARTS if mode.shares[part] >= 0.05]
    return " + ".join(sorted(large, key=lambda part: -round(mode.shares[part], 6)))


def _pace(mode: Mode) -> str:
    return f"swinging at {_number(mode.frequency)} rad/s" if mode.frequency else "without swinging"


def _robots(numbers: tuple[int, ...]) -> str:
    first, last = numbers[0], numbers[-1]
    together = len(numbers) > 2 and last - first == len(numbers) - 1
    return f"{first}-{last}" if together else ", ".join(map(str, numbers))


def _range(values: list[float]) -> str:
    low, high = _number(min(values)), _number(max(values))
    return low if low == high else f"{low} - {high}"


def _number(value: float | None, nothing: str = "none") -> str:
    """Four digits, without an exponent where that can be read."""
    if value is None:
        return nothing
    if value == 0 or 1e-4 <= abs(value) < 1e6:
        return np.format_float_positional(value, precision=4, fractional=False, trim="-")
    return f"{value:.4g}"
