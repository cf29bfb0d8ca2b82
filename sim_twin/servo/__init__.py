"""Physics of the servos: actuator models and drives."""
