"""An emulated half-duplex bus: bytes in time, collisions, the host's adapter."""
