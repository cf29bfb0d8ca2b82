"""Ground, and what of a robot touches it."""
