"""Emulated servos for tests of other programs: `ServoBus`, `ServoPty`, and pytest fixtures."""

PLUGIN = "windup.tools.testing.pytest_plugin"
"""Name under which pytest knows the fixtures."""
