"""Gains for a formation.

- ``position_gain``: the smallest δ for a damping ratio or decay rate.
- ``velocity_gain``: δ_v for a damping ratio, a pair of eigenvalues followed in ``eigenvalue_pairs``.
- ``distributed_lqr``: a design sized by the graph's degree.
- ``quadratic_cost`` and ``tuning``: δ and δ_v against effort, by gradients through the diagram.
- ``force_limited_gain`` and ``start_limited_gain``: the largest δ under a force limit, for all hand-off errors of a
  size or from the scenario's own starts.
- ``compare``: all of them side by side.
"""
