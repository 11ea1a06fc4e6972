"""A channel that carries packets: sent at times, late, lost, overtaken, and made the best of."""

from collections.abc import Hashable, Iterator
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import NonNegative, Period, Positive, Probability, Section
from drake_formation.formation.formation import Formation
from drake_formation.formation.names import channel_name
from drake_formation.parts.channels import packet_law as law
from drake_formation.parts.channels.channel import Channel
from drake_formation.parts.channels.packet_channel import PacketChannel
from drake_formation.parts.channels.profiles import PROFILES, Profile
from drake_formation.parts.channels.trace_file import Trace
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.systems.random_stream import random_start

Array = NDArray[np.float64]

Span = Annotated[tuple[float, float], Field(strict=False)]
"""From a time to another (s)."""

BASE = Profile(1e-2, 0.0, 0.0, 0.0, 1.0, "chosen")
"""What counts where no profile is named."""
NEVER = 1e12
IDEAL = ("kind", "profile", "bits")
"""What may be written of a wire."""
DISTRIBUTIONS = {"constant": law.CONSTANT, "uniform": law.UNIFORM, "gamma": law.GAMMA}
ORDERS = {"newest": law.NEWEST, "in_order": law.IN_ORDER, "buffer": law.BUFFERED}
LARGEST_QUEUE = 1024


@part("channel", kind="packets")
class Packets(Channel):
    """Packets with delays of their own, which may be lost; the receiver looks at times for what has arrived."""

    class Config(Section):
        """The network, and what the receiver makes of it."""

        profile: Literal["ideal", "urllc", "factory", "wifi", "lossy", "saturated"] | None = Field(
            default=None, description="a named network, of whose numbers those written beside it take the place"
        )
        period: Period | None = Field(default=None, description="how often a state is sent (s); chosen: 0.01")
        phase: NonNegative = Field(default=0.0, description="when first (s)")
        looks: int = Field(
            default=1, ge=1, le=1000, description="how many times a period the receiver looks for what has arrived"
        )
        trigger: NonNegative = Field(
            default=0.0, description="send only where the robot has moved farther than this since (m); 0: always"
        )
        delay: NonNegative | None = Field(default=None, description="mean delay of a packet (s); chosen: 0")
        spread: NonNegative | None = Field(
            default=None,
            description="of the delay (s): half its range where uniform, its standard deviation where gamma; chosen: 0",
        )
        distribution: Literal["constant", "uniform", "gamma"] = Field(
            default="uniform", description="how delays are distributed"
        )
        delays: Trace = Field(default=(), description="measured delays (s), packet by packet, over and over")
        loss: Probability | None = Field(default=None, description="share of packets that are lost (1); chosen: 0")
        burst: Annotated[float, Field(ge=1)] | None = Field(
            default=None,
            description="mean number of packets (1) in a bad time (Gilbert-Elliott); 1: independent losses",
        )
        burst_loss: Probability = Field(default=1.0, description="share of packets that are lost in a bad time (1)")
        losses: Trace = Field(default=(), description="measured losses (1), 1 lost and 0 not, packet by packet")
        quantum: NonNegative = Field(default=0.0, description="step to which what is sent is rounded (m, m/s); 0: none")
        clock_offset: float = Field(default=0.0, description="by how much the sender's clock is ahead (s)")
        clock_drift: float = Field(
            default=0.0, gt=-0.5, lt=0.5, description="by how much it is faster, as a share (s/s)"
        )
        order: Literal["newest", "in_order", "buffer"] = Field(
            default="newest",
            description="what the receiver takes: the newest that has arrived; one after the other as they were sent; "
            "or each at a constant delay after its time stamp",
        )
        playout: NonNegative = Field(default=0.0, description="that constant delay (s), with order: buffer")
        missing: Literal["hold", "zero", "predict"] = Field(
            default="hold",
            description="where nothing new has come: hold what was heard last, leave the neighbour out, or let it go "
            "on at the velocity heard last",
        )
        timeout: Positive | None = Field(
            default=None, description="after how long without a packet the neighbour is dropped (s); never if not given"
        )
        outages: tuple[Span, ...] = Field(
            default=(), strict=False, description="when the link is down, as pairs [from, to] (s)"
        )
        failure_rate: NonNegative = Field(default=0.0, description="how often the link fails (1/s); 0: never")
        repair_rate: NonNegative = Field(default=0.0, description="how often it is repaired (1/s); 0: never")
        range: NonNegative = Field(default=0.0, description="how far robots reach each other (m); 0: anywhere")
        bits: Positive = Field(default=256.0, description="size of a packet (bit); chosen: 8 words of 32")

    @property
    def network(self) -> Profile:
        """The profile with what is written beside it."""
        config = self.config
        base = PROFILES.get(config.profile or "", BASE)
        given = {name: getattr(config, name) for name in ("period", "delay", "spread", "loss", "burst")}
        known = {name: getattr(base, name) if value is None else value for name, value in given.items()}
        return Profile(**known, source=base.source)

    @property
    def is_wire(self) -> bool:
        """Whether it is a channel as in the paper."""
        return bool(self.config.profile == "ideal")

    @property
    def tells_traffic(self) -> bool:
        """Whether there are packets."""
        return not self.is_wire

    @property
    def listens(self) -> bool:
        """Whether it asks for the state of the robot that hears."""
        config = self.config
        return bool(config.missing == "zero" or config.timeout is not None or config.range)

    @property
    def worst_delay(self) -> float:
        """No more than one packet in a million is later (s)."""
        config, network = self.config, self.network
        if config.delays:
            return float(max(config.delays))
        width = 15.0 if config.distribution == "gamma" else 1.0
        return float(network.delay + width * network.spread * (config.distribution != "constant"))

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """What contradicts itself."""
        config, network = self.config, self.network
        # What is as by default is not told from what is not written: a scenario that was written out has everything.
        fields = {name: field for name, field in type(config).model_fields.items() if name not in IDEAL}
        given = sorted(name for name, field in fields.items() if getattr(config, name) != field.default)
        if self.is_wire and given:
            message = "an ideal channel is a wire, which has no numbers"
            yield Fault((given[0],), message, shown(getattr(config, given[0])), "another profile, or profile alone")
            return
        if config.distribution == "uniform" and network.spread > network.delay:
            message = f"delays of {network.delay:g} ± {network.spread:g} s would arrive before they are sent"
            yield Fault(("spread",), message, shown(network.spread), f"at most the delay, {network.delay:g}")
        if config.distribution == "gamma" and network.spread and not network.delay:
            yield Fault(("spread",), "a delay of 0 has no spread", shown(network.spread), "a delay above 0")
        if any(value not in (0.0, 1.0) for value in config.losses):
            yield Fault(("losses",), "a measured loss is 1 or 0", "", "1 lost, 0 not")
        if network.loss >= config.burst_loss and network.burst > 1:
            message = f"a share of {network.loss:g} cannot be lost where {config.burst_loss:g} is lost in a bad time"
            yield Fault(("loss",), message, shown(network.loss), f"below burst_loss, {config.burst_loss:g}")
        elif network.burst > 1 and network.loss / (config.burst_loss - network.loss) > network.burst:
            message = "good times would be shorter than one packet"
            yield Fault(("burst",), message, shown(network.burst), "longer bursts, or a smaller share that is lost")
        if config.order == "buffer" and not config.playout:
            yield Fault(("playout",), "missing, with order: buffer", "", "a delay (s) above 0")
        if config.playout and config.order != "buffer":
            yield Fault(("playout",), "only a buffer has a constant delay", shown(config.playout), "order: buffer")
        for k, (begin, end) in enumerate(config.outages):
            if not begin < end:
                yield Fault(("outages", k), "ends before it begins", shown([begin, end]), "[from, to] with from < to")
        if config.repair_rate and not config.failure_rate:
            yield Fault(("repair_rate",), "nothing fails", shown(config.repair_rate), "a failure_rate above 0")
        if self._rows > LARGEST_QUEUE:
            message = f"{self._rows} packets would be under way at once"
            yield Fault(("delay",), message, shown(network.delay), f"at most {LARGEST_QUEUE} periods")

    def warnings(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """What can be run but may not be meant."""
        for k, (begin, _) in enumerate(self.config.outages):
            if begin >= formation.end:
                yield Fault(("outages", k), f"begins after the end of the run at {formation.end:g} s", shown(begin))
        if self.config.order == "buffer" and self.config.playout < self.network.delay:
            message = "most packets arrive later than they are to be used, and are thrown away"
            yield Fault(
                ("playout",), message, shown(self.config.playout), f"at least the delay, {self.network.delay:g}"
            )

    @property
    def _rows(self) -> int:
        """Packets that may be under way at once; a power of two, so that a sweep over delays needs few diagrams."""
        if self.is_wire:
            return 0
        held = self.worst_delay + self.config.playout + 2 * self.network.period
        under_way = 2 + held / (self.network.period * (1.0 - abs(self.config.clock_drift)))
        return int(2 ** max(2, np.ceil(np.log2(under_way))))

    @property
    def timing(self) -> tuple[float, float]:
        """How often the receiver looks, and when first (s)."""
        return self.network.period / self.config.looks, self.config.phase

    def ticks(self) -> tuple[tuple[float, float], ...]:
        """When the receiver looks."""
        return () if self.is_wire else (self.timing,)

    def _waiting(self, formation: Formation) -> int:
        """Packets of which the medium has not yet told what became of them: one that waits, and what it is done with.

        While one is in the air, it is not told of those that were sent meanwhile.
        """
        if not formation.has_medium:
            return 0
        (medium,) = formation.parts["medium"]
        return 4 + int(medium.airtime(self.config.bits) / self.network.period)

    def layout(self, formation: Formation, owner: int) -> Hashable:  # noqa: ARG002
        """How many packets may wait for the medium; none where there is none."""
        return self._waiting(formation)

    def structure(self) -> Hashable:
        """What its block is made of."""
        if self.is_wire:
            return "wire"
        return self.timing, self.listens, self.config.missing == "predict", self._rows

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The settings, the tables, and the desired displacement."""
        if self.is_wire:
            return ()
        config, network = self.config, self.network
        distribution = law.MEASURED if config.delays else DISTRIBUTIONS[config.distribution]
        timeout = NEVER if config.timeout is None else config.timeout
        tables = [np.ravel(table) for table in (config.delays, config.losses, config.outages)]
        settings = np.array(
            [
                network.period, config.phase, network.delay, network.spread, distribution, network.loss, network.burst,
                config.burst_loss, config.quantum, config.clock_offset, config.clock_drift, config.trigger,
                ORDERS[config.order], config.playout, config.missing == "zero", timeout, config.failure_rate,
                config.repair_rate, config.range, len(config.delays), len(config.losses), len(config.outages),
                (4 + 4 * self.listens) * formation.has_medium,
            ],
            dtype=float,
        )  # fmt: skip
        listener, speaker = formation.channels.pairs[owner]
        displacement = formation.slots[listener] - formation.slots[speaker]
        return settings, *(np.array(table, dtype=float) for table in tables), displacement

    def initial_discrete_state(self, formation: Formation, owner: int) -> Numbers | None:
        """The neighbour's state is known at the start, and nothing is under way."""
        if self.is_wire:
            return None
        listener, speaker = formation.channels.pairs[owner].tolist()
        start = formation.start_state(speaker)
        begin = formation.begin
        drawn = random_start(formation.seed, channel_name(listener, speaker))
        memory = [*drawn, 0.0, 0.0, *start[:2], 0.0, begin, 1.0, 0.0]
        return (
            np.array([*start, begin, 1.0]),
            np.array([0.0, 0.0, 0.0, 0.0, 0.0, begin]),
            np.array(memory),
            np.zeros(law.ROW * (self._rows + self._waiting(formation))),
        )

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The channel, or none where it is a wire."""
        if self.is_wire:
            return None
        start = self.initial_discrete_state(formation, owner)
        predicts = self.config.missing == "predict"
        return PacketChannel(self.timing, numbers, start, self.listens, predicts, formation.has_medium)
