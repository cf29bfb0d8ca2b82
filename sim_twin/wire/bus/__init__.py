"""An emulated half-duplex bus: byte timing, collisions, the host's adapter."""
