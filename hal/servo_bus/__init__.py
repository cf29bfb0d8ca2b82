"""Joints on servo buses: readings, torque, settings and errors of the servos behind them."""
