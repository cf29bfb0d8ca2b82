"""The MuJoCo twin of a robot, as a backend and as a predictor."""
