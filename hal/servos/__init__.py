"""Data sheets of servos, one table per family, and their registers."""
