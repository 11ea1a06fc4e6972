"""What a user may write of failing robots."""

from typing import Literal

from pydantic import Field

from drake_formation.config.values import NonNegative, Positive, Section

STOPS, FREEZES, DROPS = "stops_actuating", "freezes", "drops_load"


class Failure(Section):
    """A robot that fails, and what the others do about it."""

    robot: int = Field(ge=1, description="which robot, from 1")
    time: NonNegative = Field(description="when (s), in simulated time as results have it")
    kind: Literal["stops_actuating", "freezes", "drops_load"] = Field(
        description="stops_actuating: its control force is zero from then on, and it coasts where the object drags it; "
        "freezes: its drives stop and its brakes, which take up every force on it and slip under none, bring it to "
        "rest by v̇ = −v/τ; drops_load: its springs or its grip let go of the object",
    )
    brake_time: Positive = Field(default=0.05, description="time constant τ (s) of a robot that freezes; chosen: 0.05")
    repaired_at: NonNegative | None = Field(
        default=None,
        description="when it is repaired (s), and takes hold of the object again as if it had never let go; "
        "default: never",
    )
    response: Literal["carry_on", "drop_neighbour", "re_form"] = Field(
        default="carry_on",
        description="what the others do: carry_on, nothing; drop_neighbour, consensus with it asks for nothing, either "
        "way; re_form, in addition they take the slots of the same shape with one robot less, so that they move least",
    )
    notice_after: NonNegative = Field(
        default=0.0, description="how long after the failure, and after the repair, the others respond (s); chosen: 0"
    )
