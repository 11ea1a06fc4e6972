"""What all channels of packets share: airtime, for which they compete."""
