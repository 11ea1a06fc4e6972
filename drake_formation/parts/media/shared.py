"""What all media have in common: bit rate, stations, and how radio waves spread."""

from collections.abc import Hashable, Iterator
from functools import cached_property
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import NonNegative, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.channels.packets import Packets
from drake_formation.parts.media import access
from drake_formation.parts.media.medium_block import Medium
from drake_formation.parts.part import Numbers, Part
from drake_formation.systems.random_stream import random_start

Array = NDArray[np.float64]

Retries = Annotated[int, Field(ge=0, le=1000)]
"""How often in a row a station fails before it gives a packet up."""
FADING = ("noise", "needed", "first_metre", "exponent")
"""Fields that count where a power is given."""


class Shared(Section):
    """What is shared."""

    bit_rate: float = Field(ge=1.0, le=1e10, description="how fast a packet is sent (bit/s)")
    broadcast: bool = Field(
        default=False,
        description="send a robot's state once for all who hear it, and never again; false: a packet for every channel",
    )


class Radio(Shared):
    """Airwaves: who hears whom, and how well."""

    range: NonNegative = Field(
        default=0.0, description="how far a robot is heard and disturbs others (m); 0: everywhere"
    )
    power: float | None = Field(default=None, description="sending power (dBm); no frame is lost by noise if not given")
    noise: float = Field(default=-95.0, description="noise floor (dBm); chosen: 20 MHz at 290 K, received at 6 dB")
    needed: float = Field(default=10.0, description="power above the noise that a receiver needs (dB); chosen: 10")
    first_metre: float = Field(default=40.0, description="path loss at 1 m (dB); chosen: free space at 2.4 GHz")
    exponent: float = Field(
        default=3.0,
        ge=1.0,
        le=10.0,
        description="by what power of the distance it grows (1); 2 in free space, chosen: 3",
    )


class SharedMedium(Part):
    """Airtime for which the channels of packets compete.

    Each channel is a station, or with ``broadcast`` each robot that speaks. A station keeps its newest packet alone:
    one that still waits when the next one comes is dropped. A frame takes its size by the bit rate.

    Attributes:
        protocol: rule of access, as :mod:`drake_formation.parts.media.access` numbers them.
        capacity: share of the airtime that it carries at most.
        called_so: what it is called in messages.
    """

    protocol: ClassVar[int]
    capacity: ClassVar[float] = 1.0
    called_so: ClassVar[str]
    Config: ClassVar[type[Section]] = Radio

    def airtime(self, bits: float) -> float:
        """How long a packet is in the air (s)."""
        return float(bits / self.config.bit_rate)

    def slot(self, airtimes: Array) -> float:
        """Length of a slot (s): that of the longest frame.

        Args:
            airtimes: of the channels' packets (s).
        """
        return float(airtimes.max())

    def settings(self, stations: int) -> dict[int, float]:  # noqa: ARG002
        """Its own numbers, by where they stand in the law's settings."""
        return {}

    def stations(self, formation: Formation) -> list[list[int]]:
        """The channels of every station."""
        speakers = formation.channels.pairs[:, 1].tolist()
        if not self.config.broadcast:
            return [[channel] for channel in range(len(speakers))]
        return [[c for c, s in enumerate(speakers) if s == speaker] for speaker in sorted(set(speakers))]

    def airtimes(self, formation: Formation) -> Array:
        """How long a packet of every channel is in the air (s), shape (C,)."""
        return np.array([self.airtime(channel.config.bits) for channel in formation.parts["channel"]])

    def demand(self, formation: Formation) -> float:
        """The airtime that channels ask for, by what there is, where a robot hears the most of it from its slot."""
        slots, pairs = formation.slots, formation.channels.pairs
        held = self.slots_held(self.airtimes(formation)) * self.slot(self.airtimes(formation))
        firsts = [channels[0] for channels in self.stations(formation)]
        shares = [held[first] / formation.parts["channel"][first].network.period for first in firsts]
        apart = np.linalg.norm(slots[:, None] - slots[pairs[firsts, 1]], axis=-1)
        reach = getattr(self.config, "range", 0.0) or np.inf
        return float(np.where(apart <= reach, shares, 0.0).sum(axis=1).max())

    def slots_held(self, airtimes: Array) -> Array:
        """How many slots a frame takes, for each of some airtimes (s)."""
        return np.ceil(airtimes / self.slot(airtimes) - 1e-9)

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Channels must carry packets and look for them together; what is broadcast must be sent together."""
        config, channels = self.config, formation.parts["channel"]
        if getattr(config, "power", 0.0) is None:
            for name in FADING:
                if (value := getattr(config, name)) != Radio.model_fields[name].default:
                    yield Fault((name,), "of no effect without a power", shown(value), "a power (dBm)")
        if any(not isinstance(channel, Packets) or channel.is_wire for channel in channels):
            message = "a medium is shared by channels that carry packets"
            yield Fault(("..", "channel"), message, "", "kind: packets, of another profile than ideal")
            return
        if len({channel.timing for channel in channels}) > 1:
            message = "channels that share a medium look for what has arrived at the same times"
            yield Fault(("..", "channel"), message, "", "one period by looks, and one phase, for all")
        for station in self.stations(formation) if config.broadcast else ():
            if len({_sending(channels[channel]) for channel in station}) > 1:
                message = "what is broadcast goes to all at once"
                yield Fault(("broadcast",), message, "true", "channels of a robot with the same numbers, or false")

    def warnings(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """A medium too slow for its traffic."""
        if not len(formation.channels.pairs) or (demand := self.demand(formation)) <= self.capacity:
            return
        message = f"the channels ask for {demand:.3g} of the airtime there is"
        if self.capacity < 1:
            message += f", of which {self.called_so} carries {self.capacity:.2g} at most"
        enough = self.config.bit_rate * demand / self.capacity
        yield Fault(("bit_rate",), message, shown(self.config.bit_rate), f"from about {enough:.3g} bit/s")

    def layout(self, formation: Formation, owner: int) -> Hashable:  # noqa: ARG002
        """Robots and when the channels look."""
        return formation.robots, formation.parts["channel"][0].timing if len(formation.channels.pairs) else None

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """The settings, and the tables of channels and of stations."""
        stations, pairs = self.stations(formation), formation.channels.pairs
        if not stations:
            return ()
        airtimes = self.airtimes(formation)
        settings = np.zeros(access.SETTINGS)
        settings[access.PROTOCOL], settings[access.SLOT] = self.protocol, self.slot(airtimes)
        settings[access.HALF] = formation.parts["channel"][0].timing[0] / 2
        settings[access.CHANNELS], settings[access.STATIONS] = len(pairs), len(stations)
        for place, value in (self._waves | self.settings(len(stations))).items():
            settings[place] = value
        if self.config.broadcast:
            settings[access.RETRIES] = 0.0
        owner_of = {channel: station for station, channels in enumerate(stations) for channel in channels}
        links = [[j, i, owner_of[channel]] for channel, (i, j) in enumerate(pairs.tolist())]
        lengths = self.slots_held(airtimes)
        turns = [[lengths[channels[0]], airtimes[channels[0]], channels[0]] for channels in stations]
        return settings, np.array(links, dtype=float).ravel(), np.array(turns, dtype=float).ravel()

    @cached_property
    def _waves(self) -> dict[int, float]:
        config = self.config
        if not isinstance(config, Radio):
            return {}
        waves = {access.RANGE: config.range, access.EXPONENT: config.exponent}
        if config.power is None:
            return waves
        margin = config.power - config.first_metre - config.noise - config.needed
        return waves | {access.FADES: 1.0, access.MARGIN: margin}

    def initial_discrete_state(self, formation: Formation, owner: int) -> Numbers | None:  # noqa: ARG002
        """Nothing is waiting."""
        channels = len(formation.channels.pairs)
        if not channels:
            return None
        stations = len(self.stations(formation)) * access.STATION
        reports = [np.zeros(access.REPORT) for _ in range(channels)]
        memory = np.array([*random_start(formation.seed, "medium"), 0.0])
        return np.zeros(access.DRAWN), memory, *reports, np.zeros(stations + channels)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The medium."""
        period, phase = formation.parts["channel"][0].timing
        start = self.initial_discrete_state(formation, owner)
        return Medium((period, phase + period / 2), formation.robots, numbers, start)


def _sending(channel: Packets) -> tuple[Any, ...]:
    """What decides when a channel sends, and how much."""
    config = channel.config
    return channel.network.period, config.phase, config.trigger, config.clock_drift, config.bits
