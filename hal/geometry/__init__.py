"""Angles, the up axis, gravity and the smooth step, shared by all rooms."""
