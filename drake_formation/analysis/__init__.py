"""What is guaranteed before simulating: certificates computed from the linearized diagram.

``certify`` answers everything at once::

    from drake_formation import load_scenario
    from drake_formation.analysis import certify

    certificate = certify(load_scenario("line", overrides={"consensus.delta": 1e4}))
    certificate.stable, certificate.modes, certificate.sections["delay_relative"].delay_s

Each question is a function of its own, of the ``LinearFormation`` that ``linearize`` makes of a scenario. The rooms,
each with a map in its ``__init__``, import in one direction: ``linear`` ← ``stability``, ``network``, ``response`` ←
``gains``, ``topology`` ← ``certificate``, which asks all of them, and ``report``, which puts it in words.
"""

from drake_formation.analysis.certificate import Certificate, Questions, certify
from drake_formation.analysis.gains.compare import DesignAdvice, design
from drake_formation.analysis.gains.distributed_lqr import DistributedLqr, distributed_lqr
from drake_formation.analysis.gains.force_limited_gain import ForceLimited, largest_gain
from drake_formation.analysis.gains.position_gain import SmallestDelta, smallest_delta
from drake_formation.analysis.gains.start_limited_gain import StartForce, start_force, start_limited_gain
from drake_formation.analysis.gains.tuning import Tuned, tune
from drake_formation.analysis.gains.velocity_gain import VelocityGain, velocity_gain
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import NOT_COVERED, LinearFormation, at_rest, linearize
from drake_formation.analysis.network.channel_verdict import ChannelVerdict, delay_verdict, packet_verdict
from drake_formation.analysis.network.delay_margin import DelayMargin, delay_margin
from drake_formation.analysis.network.formation_channels import channel_certificate
from drake_formation.analysis.network.intervals import Interval
from drake_formation.analysis.network.loss_margin import LossMargin, loss_margin, stable_losses
from drake_formation.analysis.network.packet_schedule import PacketChannel
from drake_formation.analysis.network.rightmost_root import rightmost_root
from drake_formation.analysis.network.sampled_data import SampledLoop, longest_period, stable_periods
from drake_formation.analysis.network.stable_delays import stable_delays
from drake_formation.analysis.response.disturbance import Disturbance, disturbance
from drake_formation.analysis.response.error_criteria import ForceNoise, HandOff, Pulse, Vibration
from drake_formation.analysis.response.obstacle_effect import ObstacleEffect, obstacle_effect
from drake_formation.analysis.response.worst_case_force import WorstCaseForce, worst_case_force
from drake_formation.analysis.stability.local_lqr import LocalLoop, Margins, local_loops
from drake_formation.analysis.stability.modes import Mode, Modes, modes
from drake_formation.analysis.stability.rigidity import SpringLinearization, spring_linearization
from drake_formation.analysis.stability.stabilization import Remedy, remedies
from drake_formation.analysis.topology.cheapest_graph import cheapest_graph, pareto_front
from drake_formation.analysis.topology.optimal_weights import (
    AveragingWeights,
    FastestWeights,
    fastest_averaging,
    fastest_weights,
)
from drake_formation.analysis.topology.results import CheapestGraph, ParetoFront

__all__ = [
    "NOT_COVERED",
    "AveragingWeights",
    "Certificate",
    "ChannelVerdict",
    "CheapestGraph",
    "DelayMargin",
    "DesignAdvice",
    "DistributedLqr",
    "Disturbance",
    "FastestWeights",
    "ForceLimited",
    "ForceNoise",
    "HandOff",
    "IllPosedError",
    "Interval",
    "LinearFormation",
    "LocalLoop",
    "LossMargin",
    "Margins",
    "Mode",
    "Modes",
    "ObstacleEffect",
    "PacketChannel",
    "ParetoFront",
    "Pulse",
    "Questions",
    "Remedy",
    "SampledLoop",
    "SmallestDelta",
    "SpringLinearization",
    "StartForce",
    "Tuned",
    "VelocityGain",
    "Vibration",
    "WorstCaseForce",
    "at_rest",
    "certify",
    "channel_certificate",
    "cheapest_graph",
    "delay_margin",
    "delay_verdict",
    "design",
    "distributed_lqr",
    "disturbance",
    "fastest_averaging",
    "fastest_weights",
    "largest_gain",
    "linearize",
    "local_loops",
    "longest_period",
    "loss_margin",
    "modes",
    "obstacle_effect",
    "packet_verdict",
    "pareto_front",
    "remedies",
    "rightmost_root",
    "smallest_delta",
    "spring_linearization",
    "stable_delays",
    "stable_losses",
    "stable_periods",
    "start_force",
    "start_limited_gain",
    "tune",
    "velocity_gain",
    "worst_case_force",
]
