"""Leader and followers: each follower keeps its place beside the robot that it hears, which need not be the leader."""

from collections.abc import Hashable, Iterator, Mapping
from typing import Annotated, Any

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.errors import Fault, shortened, shown
from drake_formation.formation.formation import Formation
from drake_formation.formation.links import Channels
from drake_formation.parts.coordination.local_weights import LocalWeights
from drake_formation.parts.coordination.none import NoForce
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.lqr import lqr_gain, tracking_force
from drake_formation.parts.tracking.none import NoTracking
from drake_formation.systems.templates import block_template, in_double


def predecessors(channels: Channels, leader: int) -> dict[int, int]:
    """Whom each robot follows: the one before it on a shortest way that the leader's state takes to it.

    Where several are, it is the one reached first, by the robots' numbers. The channels' weights have no say.

    Args:
        channels: who hears whom.
        leader: index of the robot that leads.

    Returns:
        The predecessor of every robot that the leader's state reaches, without the leader.
    """
    speaking = nx.empty_graph(channels.robots, create_using=nx.DiGraph)
    speaking.add_edges_from((j, i) for i, j in channels.pairs.tolist())
    return {follower: followed for followed, follower in nx.bfs_edges(speaking, leader)}


@block_template("Follower_", __name__)
def Follower_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`Follower`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A follower's control −K (x_i − x_j − [h_i − h_j; 0]) about the state of the robot j that it follows.

        Input ports: ``state`` (size 4) and ``channel_j`` (the state it hears, size 4). Output port: ``force`` (N, size
        2). Parameters: 0, the gain K row by row (N/m, N s/m); 1, the desired displacement h_i − h_j (m).
        """

        def _construct(self, followed: int, gain: ArrayLike, displacement: ArrayLike, *, converter: Any = None) -> None:
            """Make the controller.

            Args:
                followed: number of the robot j (from 1), which names the channel port.
                gain: K, shape (2, 4).
                displacement: h_i − h_j (m), shape (2,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (followed, gain, displacement)
            self.kind = "follower"  # all that it computes with is a parameter
            self._state = self.DeclareVectorInputPort("state", 4)
            self._heard = self.DeclareVectorInputPort(f"channel_{followed}", 4)
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(gain)))
            self.DeclareNumericParameter(BasicVector_[T](displacement))
            self.DeclareVectorOutputPort(
                "force", 2, self._calc_force, {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_force(self, context: Any, output: Any) -> None:
            x, y, vx, vy = self._state.Eval(context).tolist()
            nx, ny, nvx, nvy = self._heard.Eval(context).tolist()
            gain = context.get_numeric_parameter(0).CopyToVector().tolist()
            hx, hy = context.get_numeric_parameter(1).CopyToVector().tolist()
            error = (x - nx - hx, y - ny - hy, vx - nvx, vy - nvy)
            output.SetFromVector(np.array(tracking_force(error, gain)))

    return Impl


Follower = in_double(Follower_)


@part("coordination", kind="leader_follower")
class LeaderFollower(Part):
    """Followers keep their displacement from their predecessor on a tree of channels that begins at the leader.

    The leader exerts no force here: it tracks the reference, and followers need not (``tracking.kind: {1: lqr, default:
    none}``). A robot that keeps its place beside a leader or neighbour is Wang's (Navigation strategies for multiple
    autonomous mobile robots moving in formation, J. Robotic Systems 8(2), 1991); the tree is the control graph of
    Desai, Ostrowski and Kumar (Modeling and control of formations of nonholonomic mobile robots, IEEE Trans. Robotics
    and Automation 17(6), 2001). The gain is that of the local LQR (paper, Eqs. 11-12), with weights of its own.
    """

    class Config(LocalWeights):
        """Who leads, and the weights by which others follow."""

        leader: Annotated[int, Field(ge=1)] = Field(default=1, description="number of the robot that leads, from 1")

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether there is such a leader, whether its state reaches the robot, and whether the weights give a gain."""
        yield from self.config.regulator.checks(formation, owner)
        if self.config.leader > formation.robots:
            message = f"there is no robot {self.config.leader}"
            yield Fault(("leader",), message, shown(self.config.leader), f"one of the robots 1 to {formation.robots}")
        elif not self.leads(owner) and owner not in self._tree(formation):
            reached = sorted({self.config.leader, *(i + 1 for i in self._tree(formation))})
            message = f"robot {owner + 1} hears neither its leader, robot {self.config.leader}, nor who follows it"
            allowed = f"a channel to robot {owner + 1} from one of: {shortened(', '.join(map(str, reached)))}"
            yield Fault(("graph",), message, allowed=allowed)

    def warnings(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether a leader has nothing to follow itself, or a follower two things."""
        path, tracks = ("..", "tracking", "kind"), not isinstance(formation.parts["tracking"][owner], NoTracking)
        if self.leads(owner) and not tracks:
            message = f"robot {owner + 1} leads and tracks no reference"
            yield Fault(path, message, allowed="another kind than none for it")
        if not self.leads(owner) and tracks:
            message = "a follower tracks the reference too"
            yield Fault(path, message, allowed="{1: lqr, default: none} where robot 1 leads")

    def structure(self) -> Hashable:
        """Who leads, which says who is heard."""
        return int(self.config.leader)

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """A follower's gain and its displacement; none of the leader."""
        if self.leads(owner):
            return ()
        weights = self.config.regulator
        gain = lqr_gain(float(formation.masses[owner]), weights.state_cost, weights.input_cost)
        return gain, formation.slots[owner] - formation.slots[self._tree(formation)[owner]]

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """A follower's controller, or a leader's without force."""
        return NoForce() if self.leads(owner) else Follower(self._tree(formation)[owner] + 1, *numbers)

    def leads(self, owner: int) -> bool:
        """Whether the robot is its own leader."""
        return bool(self.config.leader == owner + 1)

    def _tree(self, formation: Formation) -> Mapping[int, int]:
        """:func:`predecessors`, worked out once for a formation."""
        trees: dict[int, dict[int, int]] = formation.kept.setdefault("predecessors", {})
        leader = self.config.leader - 1
        if leader not in trees:
            trees[leader] = predecessors(formation.channels, leader)
        return trees[leader]
