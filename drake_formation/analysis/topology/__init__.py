"""Which channels to have.

- ``cheapest_graph``: the fewest channels for an error, and what every channel buys; answers are in ``results``.
- ``study``: trying graphs, from ``enumeration`` where all can be tried and ``search`` where not, below ``bounds`` that
  no graph beats; ``reduced_graphs`` makes the loop of each from one linearization.
- ``optimal_weights``: the best weights for the channels of a graph.
"""
