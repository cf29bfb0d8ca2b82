"""Inspection of a robot folder, file by file, for `windup check`."""
