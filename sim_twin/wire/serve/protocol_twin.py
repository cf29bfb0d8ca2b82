"""Handler of ``twin://``; pyserial looks for a module of this name."""

from windup.sim_twin.wire.serve.port import TwinSerial


def serial_class_for_url(url: str) -> tuple[str, type[TwinSerial]]:
    """Return the URL and the class that opens it."""
    return url, TwinSerial
