"""A robot's folder looked at as a whole: all mistakes at once, and what is doubtful."""
