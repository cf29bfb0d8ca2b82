"""Faults of emulated buses: their text form, their methods and their effects."""
