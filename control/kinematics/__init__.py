"""Forward and inverse kinematics: whole body, soles, support regions and momenta."""
