"""How strongly things fall, and what a data sheet means by one g."""

GRAVITY = 9.81
"""m/s2: MuJoCo's own, which the twin and the controllers' equations share."""
STANDARD_GRAVITY = 9.80665
"""m/s2: the unit g in which accelerometers count (ISO 80000-3)."""
