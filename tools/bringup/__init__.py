"""Looking for servos, and at the health of a robot."""
