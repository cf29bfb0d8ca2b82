"""Walks on a computer that is slow."""
