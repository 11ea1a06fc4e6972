"""Whether the formation returns to rest.

- ``modes``: the modes of the closed loop by Laplacian eigenvalue (Theorem 2).
- ``local_lqr``: the local loop of every robot, its Riccati and Lyapunov checks and margins (Theorem 1).
- ``rigidity``: which motions the carried object resists.
- ``stabilization``: why a loop is unstable, and what was found to cure it.
"""
