"""Emulated buses for other programs: pseudo-terminals, TCP ports, traces."""
