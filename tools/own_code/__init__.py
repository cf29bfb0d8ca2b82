"""Controllers and behaviours in a user's file or an installed package, for `windup run`."""
