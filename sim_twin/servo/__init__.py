"""The servo as physics."""
