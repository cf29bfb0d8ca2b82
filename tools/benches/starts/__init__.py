"""Random starts of a robot: how it is when it is switched on, and what may be wrong with it."""
