"""Inverse dynamics as a quadratic program over the whole body."""
