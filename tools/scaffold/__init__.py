"""Small working examples that `windup new` writes: a robot, a gait, a controller."""
