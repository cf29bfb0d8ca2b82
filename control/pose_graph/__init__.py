"""Pose control graphs and gaits: file format, checks, tracking, styles and blends."""
