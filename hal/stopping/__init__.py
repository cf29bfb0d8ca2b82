"""Stopping a robot from another process, with the standard library alone."""
