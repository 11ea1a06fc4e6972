"""The linear formation: ẋ = A x + B f about the formation at rest, from the diagram.

- ``linearization``: the loop in parts, and what it says nothing about.
- ``assumptions``: what the rest relies on, and refuses to do without.
- ``motion_subspaces``: translation, rotation, breathing and shape, as subspaces of the displacements.
- ``control_gains``: forces as a linear map of the deviation.
- ``block_diagonal``: parts that do not act on each other.
- ``norms``: H2 and H∞.
- ``well_posed``: what it takes to agree at all (Lemma 1).
- ``errors``: questions without a number for an answer.

Nothing here imports the other rooms.
"""
