"""Regulation variables of a step, step records, and detection of disturbances and ground."""
