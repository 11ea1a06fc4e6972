"""Which numbers of a scenario have sliders: those of the view in the browser, and the loss of packets."""

from drake_formation.parts.channels.packets import Packets
from drake_formation.scenario import Scenario, resolve
from drake_formation.viz.view.knobs import KNOBS, Knob


class LossKnob(Knob):
    """The share of packets that are lost, which a named network may say in place of the scenario."""

    def shown(self, scenario: Scenario) -> float | None:
        """Where the slider stands; None where channels carry no packets, or are unlike, or losses were measured."""
        channels = resolve(scenario).parts["channel"]
        if not all(isinstance(part, Packets) and not part.is_wire and not part.config.losses for part in channels):
            return None
        losses = {part.network.loss for part in channels}
        return min(losses.pop(), self.high) if len(losses) == 1 else None


LOSS = LossKnob("loss", "consensus.channel.loss", 0.0, 0.9, 0.01)
ALL = (*KNOBS, LOSS)
