"""Frames of the servo protocols: pure functions on bytes, no port and no clock."""
