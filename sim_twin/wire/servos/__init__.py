"""Emulated servos: registers, control loops, protection functions."""
