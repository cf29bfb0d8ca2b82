"""Encoding and decoding of servo protocol frames: pure functions on bytes, without I/O."""
