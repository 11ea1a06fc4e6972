"""What the channels may do to the formation, and to any linear system: late, sampled and lost packets.

- ``stable_delays``: the ``intervals`` of delays at which a linear system is stable, from all ``delay_crossings``: of
  the quadratic eigenproblem (small systems) or by ``delay_branch_and_bound`` (large ones), which follow roots to the
  imaginary axis in ``crossing``. ``delay_margin``: how old the robots' states may be.
- ``sampled_data``: packets once a period, forces held in between; the periods at which that is stable.
- ``loss_margin``: how many packets may be lost; by ``mean_square`` stability.
- ``formation_channels``: whether the formation is stable over its channels, by the ``channel_verdict`` on a linear
  system: from its ticks where they carry ``packets``, at the times of their ``packet_schedule``, and from its
  ``rightmost_root`` where they are pure delays.
"""
