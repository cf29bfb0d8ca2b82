"""Foreseeing a fall, and falling softly."""
