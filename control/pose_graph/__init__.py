"""Pose control graphs and gaits: their files, their tracking, their styles."""
