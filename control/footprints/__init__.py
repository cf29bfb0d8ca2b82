"""Walking given footprints: file format, checks, swing curves and controllers."""
