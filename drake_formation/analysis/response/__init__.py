"""What blows, vibration, noise and hand-offs do to the formation.

- ``disturbance``: how far forces and noise drive the robots apart; ``impulse_peak`` bounds a blow for all time.
- ``peak_norm`` and ``worst_case_force``: the largest control force over all hand-off errors of a size.
- ``error_criteria``: the stated disturbances by which graphs are judged.
- ``obstacle_effect``: what the obstacles of a simulated run did, against what the loop promises.
"""
