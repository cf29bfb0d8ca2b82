"""The example robot, gait and controller that `windup new` writes."""
