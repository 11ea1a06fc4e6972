"""What breaks and fails in a formation, as blocks of its diagram; where nothing can, there are none."""

from collections.abc import Sequence
from typing import Any

from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import Adder

from drake_formation.formation.formation import Formation
from drake_formation.formation.names import heeding_name, robot_name
from drake_formation.parameters import Parameters
from drake_formation.parts.objects.breaking import breaking_block, breaks
from drake_formation.parts.registry import PartError
from drake_formation.systems.hand_off import HandOff
from drake_formation.systems.heeding import Heeding
from drake_formation.systems.staged_signals import StagedSignals

STAGES, BREAKING = "stages", "breaking"
"""Names of the blocks."""

DRIVEN = "driven"
"""An output port of the diagram where drives fail: for each robot 1 while it actuates, else 0."""
BROKEN_OUTPUTS = ("intact", "broken_at")
"""Output ports of the diagram where springs or grips may break: for each 1 or 0, and when it broke (s) or 0."""


class Failing:
    """The stages of a run, which change what blocks are told.

    Args:
        builder: of the diagram.
        formation: what may fail.
        parameters: of all blocks.
    """

    def __init__(self, builder: DiagramBuilder, formation: Formation, parameters: Parameters) -> None:
        self._builder, self._formation, self._parameters = builder, formation, parameters
        self._signals: Any = None
        if not formation.signals:
            return
        later = formation.stages[1:]
        tables = parameters[STAGES]
        self._signals = builder.AddNamedSystem(STAGES, StagedSignals(len(later), [*formation.signals], tables))
        for k, stage in enumerate(later):  # as the hand-off, each a switch at which integrators stop
            switch = builder.AddNamedSystem(f"stage_{k + 1}", HandOff(stage.time))
            builder.Connect(switch.get_output_port(), self._signals.get_input_port(k))
        if DRIVEN in formation.signals:
            builder.ExportOutput(self._signals.GetOutputPort(DRIVEN), DRIVEN)

    def signal(self, name: str) -> Any:
        """The output port of a signal, or None where it never changes."""
        return self._signals.GetOutputPort(name) if name in self._formation.signals else None

    def reference(self, robot: int, centre: Any) -> Any:
        """What a robot, from 0, takes for the motion of the formation centre: with its slot, that moves too."""
        shift = self.signal(f"shift_{robot + 1}")
        if shift is None:
            return centre
        moved = self._builder.AddNamedSystem(f"{robot_name(robot)}_slot", Adder(2, 6))
        for k, port in enumerate((centre, shift)):
            self._builder.Connect(port, moved.get_input_port(k))
        return moved.get_output_port()

    def heard(self, listener: int, speaker: int, told: Any, own: Any) -> Any:
        """What a robot takes for what a channel tells it of another; see :mod:`drake_formation.systems.heeding`."""
        change = self.signal(f"heard_{listener + 1}_{speaker + 1}")
        if change is None:
            return told
        name = heeding_name(listener, speaker)
        heeding = self._builder.AddNamedSystem(name, Heeding(*self._parameters[name]))
        for port, source in (("state", own), ("told", told), ("change", change)):
            self._builder.Connect(source, heeding.GetInputPort(port))
        return heeding.get_output_port()

    def fail(self, robots: Sequence[Diagram], carried: Any) -> None:
        """Wire what fails, breaks and is let go to the robots, and to the object where it is a body of its own."""
        for i, robot in enumerate(robots):
            self._tell(robot, i, "failure", self.signal(f"failure_{i + 1}"))
            self._tell(robot, i, "held", None if carried else self.signal(f"held_{i + 1}"))
        if carried and (held := self.signal("held")):
            self._builder.Connect(held, carried.GetInputPort("held"))
        if breaks(self._formation):
            self._break(robots, carried)

    def _break(self, robots: Sequence[Diagram], carried: Any) -> None:
        """Wire the springs or grips that break."""
        block = breaking_block(self._formation, self._parameters[BREAKING])
        breaking = self._builder.AddNamedSystem(BREAKING, block)
        for k in range(breaking.num_input_ports()):
            port = breaking.get_input_port(k)
            stem, _, number = port.get_name().rpartition("_")
            source = robots[int(number) - 1].GetOutputPort(stem) if stem == "state" else None
            source = carried.GetOutputPort(port.get_name()) if stem == "grip_force" else source
            self._builder.Connect(source or self.signal(port.get_name()), port)
        for name in BROKEN_OUTPUTS:
            self._builder.ExportOutput(breaking.GetOutputPort(name), name)
        if carried:
            self._builder.Connect(breaking.GetOutputPort("intact"), carried.GetInputPort("intact"))
        for i, robot in enumerate([] if carried else robots):
            name = f"intact_{i + 1}"
            self._tell(robot, i, "intact", breaking.GetOutputPort(name) if breaking.HasOutputPort(name) else None)

    def _tell(self, robot: Diagram, index: int, name: str, source: Any) -> None:
        """Connect a source, if there is one, to a robot's input port.

        Raises:
            PartError: its plant has no such port, so that it would go on as if nothing happened.
        """
        if source is None:
            return
        if not robot.HasInputPort(name):
            plant = self._formation.parts["robot"][index]
            raise PartError(f"{plant.called()}: its block has no input port {name!r}, by which it would fail")
        self._builder.Connect(source, robot.GetInputPort(name))
