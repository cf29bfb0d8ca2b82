"""The shafts that emulated servos drive: plain inertias, or joints of a twin."""
