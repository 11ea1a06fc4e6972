"""What the channels may do to the formation: late, sampled and lost packets.

- ``delay_margin``: how old states may be; by ``delay_crossings`` (small systems) and ``delay_branch_and_bound`` (large
  ones), which follow roots to the imaginary axis in ``crossing``.
- ``sampled_data``: packets once a period, forces held in between.
- ``loss_margin``: how many packets may be lost; by ``mean_square`` stability.
"""
