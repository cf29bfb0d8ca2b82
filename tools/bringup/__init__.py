"""Finding servos on a port, and checking the health of a robot."""
