"""Emulated buses for other programs: pseudo-terminals, TCP, traces."""
