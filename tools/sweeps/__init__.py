"""Runs any command over a grid of its options."""
