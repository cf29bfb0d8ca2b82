"""Measurements taken during runs, and their formatting."""
