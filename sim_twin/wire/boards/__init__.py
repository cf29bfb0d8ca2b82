"""Emulated controller boards and sensors on a bus."""
