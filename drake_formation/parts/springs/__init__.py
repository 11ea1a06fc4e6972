"""Laws by which the carried object couples two robots."""
