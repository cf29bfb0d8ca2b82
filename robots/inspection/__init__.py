"""Inspection of a whole robot folder: all mistakes at once, and warnings."""
