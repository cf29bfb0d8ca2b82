"""Telemetry: a ring buffer in shared memory that a run writes, and other processes read."""
