"""What the channels may do to the formation, and to any linear system: late, sampled and lost packets.

- ``stable_delays``: the ``intervals`` of delays at which a linear system is stable, from all ``delay_crossings``: of
  the quadratic eigenproblem (small systems) or by ``delay_branch_and_bound`` (large ones), which follow roots to the
  imaginary axis in ``crossing``. ``delay_margin``: how old the robots' states may be.
- ``sampled_data``: packets once a period, forces held in between; the periods at which that is stable.
- ``loss_margin``: how many packets may be lost; by ``mean_square`` stability.
- ``channel_verdict``: whether a system is stable over given channels: by its ticks where they carry ``packets``, by its
  ``rightmost_root`` where they are pure delays.
"""
