"""Acceleration of gravity, and the unit g of data sheets."""

GRAVITY = 9.81
"""m/s2: the value of MuJoCo, the twin and the controllers."""
STANDARD_GRAVITY = 9.80665
"""m/s2: the unit g of accelerometers (ISO 80000-3)."""
