"""Emulated servo buses for tests of other programs."""
