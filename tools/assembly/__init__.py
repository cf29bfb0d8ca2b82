"""Putting controllers together from a robot, its files, and what the user asked for."""
