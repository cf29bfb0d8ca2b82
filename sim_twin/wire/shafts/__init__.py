"""The shafts that emulated servos turn: an inertia of their own, or a joint of a twin."""
