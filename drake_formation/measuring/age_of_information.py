"""How old what robots know of each other is: on average over time and channels, and of any channel at worst."""

from drake_formation.measuring.messages import of_packets

mean_age = of_packets("mean_age_s", "mean age of information", "s", lambda packets: packets.mean_age.mean())
peak_age = of_packets("peak_age_s", "peak age of information", "s", lambda packets: packets.peak_age.max())
