"""Stop requests to a run, and supervision of the torque between runs."""
