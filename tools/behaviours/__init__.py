"""Runs that are more than one controller: footprints, striding, pushes."""
