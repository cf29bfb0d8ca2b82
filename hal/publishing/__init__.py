"""What a run publishes about itself: the state of the robot, and the internals of a controller."""
