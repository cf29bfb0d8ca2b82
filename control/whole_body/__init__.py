"""Whole-body control: inverse dynamics as a quadratic programme."""
