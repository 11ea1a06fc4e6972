"""What becomes of a state between the robot that sends it and the one that hears it."""
