"""What asks a run to stop, and who is in charge meanwhile."""
