"""Overrides that make the line's loop unstable: input costs that tie x to y give a damping that is not symmetric."""

# x is damped a hundred times as much as y, and R couples the two: along a bar at 150° the damping is negative.
UNSTABLE = {
    "tracking.Q": [1.0, 1.0, 1e4, 1.0],
    "tracking.R": [[1.0, 0.9], [0.9, 1.0]],
    "formation.heading": 150.0,
    "springs.stiffness": 3e4,
}
# Robots of 1 kg with a costly y: the distributed LQR would be stable but for the stiff object across it.
UNSTABLE_BY_SPRINGS = {
    "formation.heading": 105.0,
    "robots.mass": 1.0,
    "tracking.Q": [1.0, 1.0, 1.0, 1e4],
    "tracking.R": [[1.0, 0.99], [0.99, 1.0]],
    "springs.stiffness": 3e4,
}
