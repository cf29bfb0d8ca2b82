"""Walking as a linear inverted pendulum plans it."""
