"""The ground of a twin, and the robot's contact with it."""
