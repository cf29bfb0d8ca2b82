"""Walking planned with a linear inverted pendulum."""
