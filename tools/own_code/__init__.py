"""Controllers and behaviours in a file of the user's own, for `windup run`."""
