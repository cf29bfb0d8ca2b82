"""Angles, axes, gravity and the smooth step: what every room means by them, each once."""
