"""What goes wrong when a diagram cannot be compiled."""


class LoweringError(ValueError):
    """A diagram that cannot be compiled; the message names the block and says why.

    Attributes:
        block: path of the block in the diagram, such as ``robot_1/plant``.
        reason: why, without the block's name.
    """

    def __init__(self, block: str, reason: str) -> None:
        super().__init__(f"block {block!r} cannot be compiled: {reason}")
        self.block = block
        self.reason = reason
