"""Where a walk goes: speed, side, turns, courses, slopes and slipping feet."""
