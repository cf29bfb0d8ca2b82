"""Emulated buses with their devices, physics and time, as one world."""
