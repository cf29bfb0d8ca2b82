"""Bodies, soles, support and momenta of a robot in a pose, and the inverse kinematics."""
