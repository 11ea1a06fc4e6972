"""What becomes of the control force asked of a robot."""
