"""Steering of a walk: speed, sideways speed, turns, courses, slopes and slipping feet."""
