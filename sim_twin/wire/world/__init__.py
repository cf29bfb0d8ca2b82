"""Worlds: emulated buses with their devices, physics and clock."""
