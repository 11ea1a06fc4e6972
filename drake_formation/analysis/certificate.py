"""One certificate of a scenario: what is guaranteed before simulating it, what is not, and what has no answer."""

import json
import platform
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version
from typing import Any

import networkx as nx
from threadpoolctl import threadpool_limits

from drake_formation.analysis.linear.assumptions import require_displacements
from drake_formation.analysis.linear.errors import UNSOLVABLE, IllPosedError
from drake_formation.analysis.linear.linearization import NOT_COVERED, LinearFormation, linearize
from drake_formation.analysis.network.channel_verdict import ChannelVerdict
from drake_formation.analysis.stability.modes import Modes, modes
from drake_formation.analysis.stability.stabilization import Remedy, cause, remedies
from drake_formation.scenario import Scenario

LONGEST_PERIOD = 10.0
"""No loss margin is looked for at a longer sampling period (s)."""

WIRES = "channels: all but the verdict and the section on them is for a formation whose channels are wires"
"""What is not covered, besides, where they are not."""

UNITS = {
    "keys": "SI; a key ends in its unit, and what has none is a pure number or one of those below",
    "gain": "columns 1 and 2 in N/m, 3 and 4 in N s/m",
    "P, lyapunov_decrease": "of the cost x'Px with x in m and m/s, in the units of Q and R",
    "laplacian_eigenvalue": "of the communication graph, a pure number",
    "loss_margin": "probability, from 0 to 1",
    "smallest_eigenvalue": "of R'R, R the rigidity matrix with rows of length √2: a pure number",
}
"""What the numbers of a certificate are measured in."""


@dataclass(frozen=True)
class Questions:
    """What a certificate is asked beyond what it always answers.

    Attributes:
        period_s: sampling period of the loss margin (s); None for 10 ms or, where the loop does not tolerate that even
            without loss, half the longest it tolerates.
        damping_ratio: look for the smallest δ that gives every mode that consensus moves this damping ratio.
        decay_rate: look for the smallest δ that gives every such mode this decay rate (1/s).
        force_limit: look for the largest δ under this force (N).
        consensus_error: look for the fewest channels that keep the consensus error below this (m).
    """

    period_s: float | None = None
    damping_ratio: float | None = None
    decay_rate: float | None = None
    force_limit: float | None = None
    consensus_error: float | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be asked.

        Raises:
            IllPosedError: a value is not finite and above 0, a period above 10 s, or a damping ratio above 1.
        """
        for name, value in vars(self).items():
            if value is not None and not 0 < value < float("inf"):
                raise IllPosedError(
                    f"{name.removesuffix('_s').replace('_', ' ')} is {value:g}; allowed: finite and above 0"
                )
        if self.period_s is not None and self.period_s > LONGEST_PERIOD:
            raise IllPosedError(f"period is {self.period_s:g}; allowed: above 0 and at most {LONGEST_PERIOD:g}")
        if self.damping_ratio is not None and self.damping_ratio > 1:
            raise IllPosedError(f"damping ratio is {self.damping_ratio:g}; allowed: above 0 and at most 1")


@dataclass(frozen=True)
class Certificate:
    """What is guaranteed about a scenario's formation at rest, from its linearized diagram.

    Attributes:
        scenario: as given, every default resolved.
        formation: its linearization.
        modes: the modes of the closed loop, stable or not.
        questions: what it was asked beyond the standard sections.
        sections: answers by name (see ``SECTIONS``), each with a ``to_dict``.
        unanswered: for sections without an answer, why there is none.
    """

    scenario: Scenario
    formation: LinearFormation
    modes: Modes
    questions: Questions = Questions()
    sections: dict[str, Any] = field(default_factory=dict)
    unanswered: dict[str, str] = field(default_factory=dict)

    @property
    def channels(self) -> ChannelVerdict | None:
        """What is certain over the scenario's channels; None where they are wires."""
        return self.sections.get("channels")

    @property
    def stable(self) -> bool | None:
        """Whether the formation returns to rest from every small deviation, over its channels as they are.

        None where that is not certified: rounding hides it, or nothing is known about such channels.
        """
        if self.channels is None:
            return self.modes.stable
        return {"stable": True, "unstable": False}.get(self.channels.label)

    @property
    def not_covered(self) -> tuple[str, ...]:
        """What the certificate says nothing about."""
        return NOT_COVERED if self.channels is None else (*NOT_COVERED, WIRES)

    @cached_property
    def cause(self) -> str | None:
        """Why the loop is unstable even over wires, in a sentence; None for others."""
        return cause(self.formation) if self.modes.stable is False else None

    @cached_property
    def remedies(self) -> tuple[Remedy, ...]:
        """Changes that make a loop stable that is unstable even over wires; none for others."""
        return remedies(self.formation) if self.modes.stable is False else ()

    @cached_property
    def no_limit(self) -> list[str]:
        """Margins that were computed and found to have no limit."""
        limits = {
            "delay_margin_s.neighbour": ("delay_neighbour", "delay_s"),
            "delay_margin_s.relative": ("delay_relative", "delay_s"),
            "loss_margin": ("loss", "probability"),
        }
        return [
            name
            for name, (section, value) in limits.items()
            if section in self.sections and getattr(self.sections[section], value) is None
        ]

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.certificate import certificate_html

        return certificate_html(self)

    def to_dict(self) -> dict[str, Any]:
        """Plain values; null where a section has no answer (see ``unanswered``) or a margin no limit (``no_limit``)."""
        answers = {name: _plain(self.sections.get(name)) for name in SECTIONS}
        return {
            "name": self.scenario.name,
            "stable": self.stable,
            "cause": self.cause,
            "remedies": [remedy.to_dict() for remedy in self.remedies],
            "modes": [mode.to_dict() for mode in self.modes.modes],
            "laplacian_eigenvalues": self.modes.laplacian_eigenvalues.tolist(),
            "decay_limit_1_per_s": self.modes.decay_limit,
            "delay_margin_s": {
                "neighbour": getattr(self.sections.get("delay_neighbour"), "delay_s", None),
                "relative": getattr(self.sections.get("delay_relative"), "delay_s", None),
            },
            "loss_margin": getattr(self.sections.get("loss"), "probability", None),
            "no_limit": self.no_limit,
            "unanswered": self.unanswered,
            **answers,
            "not_covered": list(self.not_covered),
            "units": UNITS,
            "versions": versions(),
            "scenario": self.scenario.model_dump(mode="json"),
        }

    def to_json(self) -> str:
        """The same as JSON, by its standard: no NaN, no infinity."""
        return json.dumps(self.to_dict(), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def certify(
    scenario: Scenario,
    *,
    questions: Questions | None = None,
    progress: Callable[[str], None] | None = None,
) -> Certificate:
    """Certify a scenario.

    Args:
        scenario: what to certify; see :func:`drake_formation.analysis.linearize` for what of it plays a part.
        questions: what to answer beyond the standard sections.
        progress: called with the name of every section before it is computed.

    Returns:
        The certificate, also of an unstable loop: it says so, and which sections have no answer then.

    Raises:
        ScenarioError: the scenario is wrong.
    """
    # Many small matrices: threads of the linear algebra would wait for one another most of the time.
    with threadpool_limits(limits=1, user_api="blas"):
        return _certified(scenario, questions or Questions(), progress)


def _certified(scenario: Scenario, asked: Questions, progress: Callable[[str], None] | None) -> Certificate:
    formation = linearize(scenario)
    sections: dict[str, Any] = {}
    unanswered: dict[str, str] = {}
    for name, answer in SECTIONS.items():
        if progress:
            progress(name)
        try:
            result = answer(formation, asked)
        except IllPosedError as error:
            unanswered[name] = str(error)
        except UNSOLVABLE as error:
            unanswered[name] = f"the numbers of the scenario are too far apart in size to compute it ({error})"
        else:
            if result is not None:
                sections[name] = result
    return Certificate(scenario, formation, modes(formation), asked, sections, unanswered)


def versions() -> dict[str, str]:
    """Versions of what a certificate was computed with."""
    packages = ("drake-formation", "drake", "numpy", "scipy")
    return {"python": platform.python_version(), **{package: version(package) for package in packages}}


def _plain(section: Any) -> Any:
    if isinstance(section, tuple):
        return [part.to_dict() for part in section]
    return None if section is None else section.to_dict()


def _local(formation: LinearFormation, _: Questions) -> Any:
    from drake_formation.analysis.stability.local_lqr import local_loops

    return local_loops(formation)


def _springs(formation: LinearFormation, _: Questions) -> Any:
    from drake_formation.analysis.stability.rigidity import spring_linearization

    return spring_linearization(formation)


def _channels(formation: LinearFormation, _: Questions) -> Any:
    from drake_formation.analysis.network.formation_channels import channel_certificate

    return channel_certificate(formation)


def _rigidity(formation: LinearFormation, _: Questions) -> Any:
    from drake_formation.analysis.stability.held_shape import held_shape

    return held_shape(formation.resolved)


def _smallest_delta(formation: LinearFormation, asked: Questions) -> Any:
    from drake_formation.analysis.gains.position_gain import smallest_delta

    if asked.damping_ratio is None and asked.decay_rate is None:
        return None
    return smallest_delta(formation, damping_ratio=asked.damping_ratio, decay_rate=asked.decay_rate)


def _delay_neighbour(formation: LinearFormation, _: Questions) -> Any:
    from drake_formation.analysis.network.delay_margin import delay_margin

    return delay_margin(formation, of="neighbour")


def _delay_relative(formation: LinearFormation, _: Questions) -> Any:
    from drake_formation.analysis.network.delay_margin import delay_margin

    return delay_margin(formation, of="relative")


def _loss(formation: LinearFormation, asked: Questions) -> Any:
    from drake_formation.analysis.network.loss_margin import PERIOD, loss_margin
    from drake_formation.analysis.network.sampled_data import longest_period

    if asked.period_s is not None:
        return loss_margin(formation, period_s=asked.period_s)
    longest = longest_period(formation, up_to_s=2 * PERIOD) if formation.robots > 1 else None
    return loss_margin(formation, period_s=PERIOD if longest is None or longest > PERIOD else longest / 2)


def _disturbance(formation: LinearFormation, _: Questions) -> Any:
    from drake_formation.analysis.response.disturbance import disturbance

    return disturbance(formation)


def _topology(formation: LinearFormation, asked: Questions) -> Any:
    from drake_formation.analysis.topology.cheapest_graph import cheapest_graph

    if asked.consensus_error is None:
        return None
    return cheapest_graph(formation, error_bound_m=asked.consensus_error)


def _design(formation: LinearFormation, asked: Questions) -> Any:
    from drake_formation.analysis.gains.compare import design

    if formation.robots < 2:
        raise IllPosedError("one robot has no consensus gains to choose")
    require_displacements(formation.resolved, "advice on gains")
    if not nx.is_connected(formation.resolved.channels.graph):
        raise IllPosedError("the communication graph is not connected, so no gains make the robots agree (Lemma 1)")
    return design(formation, force_limit_n=asked.force_limit)


SECTIONS: dict[str, Callable[[LinearFormation, Questions], Any]] = {
    "channels": _channels,
    "local": _local,
    "springs": _springs,
    "rigidity": _rigidity,
    "smallest_delta": _smallest_delta,
    "delay_neighbour": _delay_neighbour,
    "delay_relative": _delay_relative,
    "loss": _loss,
    "disturbance": _disturbance,
    "design": _design,
    "topology": _topology,
}
"""What a certificate answers beside the modes; a section may return None where nothing was asked."""
